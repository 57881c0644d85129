#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline report {

// Everything that a report shows, as plain data. All coordinates are the source's raw ones [m], all
// times are seconds of the drive. Texts are shown as they are: the report escapes them.

/// N points of a line [m], in source coordinates.
using LineInSource = std::vector<Eigen::Vector2d>;

/// A lane as the map shows it.
struct ReportLane {
  std::string name;
  map::LaneType type = map::LaneType::none;
  bool in_junction = false;
  LineInSource left, centre, right;
};

/// An end state of a planning cycle and what it costs.
struct ReportCandidate {
  double end_d_m = 0.0, end_l_m = 0.0;
  std::vector<double> costs;  ///< weighted, one per name in ReportInput::cost_names
};

/// What became of each end state of a planning cycle.
struct ReportGrid {
  std::vector<double> end_d_m, end_l_m;  ///< ascending
  std::vector<std::uint8_t> causes;      ///< index in ReportInput::cause_names, d fastest
};

/// Where a planning cycle's candidates start, in the frame of the reference line.
struct ReportStart {
  double s_m = 0.0, d_m = 0.0, d_slope = 0.0, d_curvature_per_m = 0.0;
};

/// What one planning cycle chose.
struct ReportPlan {
  double t_s = 0.0;
  LineInSource path;   ///< empty: the cycle found nothing
  std::string note;    ///< "ends 0.4 m to the left after 22 m"
  std::string reason;  ///< of the decision in force; empty: that of its ReportDecision
  ReportStart start = {};
  std::optional<ReportCandidate> chosen = {}, runner_up = {};
  std::optional<ReportGrid> grid = {};  ///< none: it was not kept
};

struct ReportSeries {
  std::string name;            ///< "speed", "target", "limit"
  std::vector<double> values;  ///< one per time of its plot; not finite: a gap
};

/// One diagram over time; its series share their times.
struct ReportPlot {
  std::string title;                   ///< "Speed"
  std::string unit;                    ///< "m/s"
  std::vector<double> t_s;             ///< increasing
  std::vector<ReportSeries> series;    ///< at least one
  std::optional<double> lower, upper;  ///< bounds that are checked; shaded beyond
};

enum class Severity { info, warning, fault };

/// Something that happened at a moment; a click in the report goes there.
struct ReportEvent {
  double t_s = 0.0;
  Severity severity = Severity::info;
  std::string text;
};

/// A stretch of the drive in one state of the decision layer.
struct ReportDecision {
  double from_s = 0.0, to_s = 0.0;
  std::string state;   ///< "follow", few different ones
  std::string reason;  ///< "car 17 is 22 m ahead"
};

/// A row of the table of what was checked.
struct ReportCheck {
  std::string name;             ///< "least clearance"
  std::optional<double> value;  ///< none: not measured
  std::string unit;             ///< "m"
  std::string bound;            ///< "≥ 0.30", empty if it is only noted
  bool passed = true;
  std::optional<double> at_s;  ///< when the value was taken
};

/// A file that the drive was made from.
struct ReportSource {
  std::string role;    ///< "map"
  std::string name;    ///< as the user named it
  std::string sha256;  ///< of its bytes, hexadecimal
};

/// A drawing of a moment.
struct ReportPicture {
  double t_s = 0.0;
  std::string text;  ///< what it shows
  std::string svg;   ///< markup, put into the page as it is
};

enum class Tone { good, open, bad };

/// One line that says how it went.
struct ReportVerdict {
  Tone tone = Tone::open;
  std::string text;  ///< "goal reached after 41.2 s, 512 m; nothing touched"
};

struct ReportInput {
  std::string title;     ///< of the page
  std::string scenario;  ///< its name
  ReportVerdict verdict;

  std::vector<ReportLane> lanes;
  std::vector<LineInSource> route;  ///< centrelines of its legs
  LineInSource reference;
  std::optional<Eigen::Vector2d> goal;
  std::vector<map::Box2> occupied;  ///< cells near the drive, in plan

  geometry::VehicleShape vehicle;
  std::vector<LineInSource> parts_in_vehicle;  ///< outlines to draw besides its rectangle
  geometry::Trajectory drive;                  ///< may be empty
  std::vector<planning::Obstacle> obstacles;
  std::vector<ReportPlan> plans;                     ///< by time, one per cycle; may be empty
  std::vector<std::string> cost_names, cause_names;  ///< of the plans' candidates

  std::vector<ReportPlot> plots;
  std::vector<ReportEvent> events;        ///< by time
  std::vector<ReportDecision> decisions;  ///< by time, not overlapping
  std::vector<ReportCheck> checks;
  std::vector<ReportPicture> pictures;  ///< by time
  std::optional<ReportVerdict> audit;   ///< none: no occupancy was given

  std::string command;  ///< line that makes the drive again
  std::string version;  ///< "roadbed 0.1.0"
  std::string crs;      ///< of the coordinates, empty if unknown
  std::vector<ReportSource> sources;
};

/// One HTML page that plays the drive, from `file://`, without any other file and without network.
/// Same input, same bytes.
/// @throws std::invalid_argument if a plot's series differ in length from its times.
std::string drive_report_html(const ReportInput& input);

}  // namespace roadbed::tools
