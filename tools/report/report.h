#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline report {

// Everything that a report shows, as plain data: a drive as it was driven, and around it what only
// pages have. All coordinates are the source's raw ones [m], all times are seconds of the drive.
// Texts are shown as they are: the report escapes them.

/// N points of a line [m], in source coordinates.
using LineInSource = std::vector<Eigen::Vector2d>;

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
  std::optional<double> at_s;   ///< when the value was taken
  std::string bound_from = {};  ///< what the bound comes from: "comfort, nuPlan"
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

Tone tone_of(planning::Verdict verdict);

/// One line that says how it went.
struct ReportVerdict {
  Tone tone = Tone::open;
  std::string text;  ///< "goal reached after 41.2 s, 512 m; nothing touched"
};

/// What is around a drive.
struct ReportScene {
  std::shared_ptr<const map::RoadMap> road_map;  ///< near the drive; none: not driven on a map
  std::vector<LineInSource> route;       ///< centrelines of its legs; of routes given up, as driven
  std::vector<LineInSource> references;  ///< line of each route in turn, that of the last one last
  std::optional<Eigen::Vector2d> goal;
  std::vector<map::Box2> occupied;  ///< cells near the drive, in plan
  geometry::VehicleShape vehicle;
  std::vector<LineInSource> parts_in_vehicle;         ///< outlines to draw besides its rectangle
  std::vector<planning::ObstacleInSource> obstacles;  ///< in source coordinates
};

/// What a page was made from, and how it is made again.
struct ReportOrigin {
  std::string command;  ///< line that makes it again
  std::string version;  ///< "roadbed 0.1.0"
  std::string crs;      ///< of the coordinates, empty if unknown
  std::vector<ReportSource> sources;
};

struct ReportInput {
  std::string title;     ///< of the page
  std::string scenario;  ///< its name
  ReportVerdict verdict;
  std::optional<ReportVerdict> audit;  ///< none: no occupancy was given
  ReportScene scene;
  Drive drive;  ///< its trajectory, cycles and events are shown; all may be empty
  std::vector<ReportPlot> plots;
  std::vector<ReportDecision> decisions;  ///< by time, not overlapping
  std::vector<ReportCheck> checks;
  std::vector<ReportPicture> pictures;  ///< by time
  ReportOrigin origin;
  planning::CostTerms weights = planning::default_weights();  ///< of the candidates' cost
};

/// One HTML page that plays the drive, from `file://`, without any other file and without network.
/// Same input, same bytes.
/// @throws std::invalid_argument if a plot's series differ in length from its times.
std::string drive_report_html(const ReportInput& input);

/// The whole drive as one picture on its own background, 900 wide: lanes, route, driven path
/// coloured by speed, footprints every few seconds, obstacles, scale bar and legend. Same input,
/// same bytes.
std::string drive_scene_svg(const ReportInput& input);

}  // namespace roadbed::tools::report
