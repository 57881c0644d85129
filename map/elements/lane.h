#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/id.h"
#include "roadbed/map/elements/participants.h"

namespace roadbed::map::inline elements {

/// What a lane is for. OpenDRIVE's lane types; other formats map onto them.
enum class LaneType {
  none,
  driving,
  bidirectional,
  entry,
  exit,
  on_ramp,
  off_ramp,
  connecting_ramp,
  shoulder,
  stop,
  parking,
  border,
  biking,
  sidewalk,
  curb,
  median,
  restricted,
  roadworks,
  tram,
  rail,
  bus,
  taxi,
  other,
};

/// The source's own word: "driving", "onRamp", …
std::string_view to_string(LaneType type);

/// Whether a car may plan to drive along the lane.
bool is_drivable(LaneType type);

/// Whether the lane is road surface that a car may touch: drivable lanes, shoulders, parking,
/// stops.
bool is_surface(LaneType type);

/// A place along a lane, in driving direction.
///
///          d > 0 (left)
///     ●──────┼───────────▶ s     centreline
///          d < 0 (right)
struct LanePlace {
  LaneId lane;
  double s_m = 0.0;
  double d_m = 0.0;
};

/// One of the three lines of a lane, in driving direction.
struct LaneLine {
  geometry::Polyline in_map;      ///< [m]
  std::vector<double> z_m;        ///< elevation, one per point
  std::vector<double> station_m;  ///< of the lane's centreline, one per point, 0 … length
};

/// What OpenDRIVE knows of the place of a lane: its road, section, and the range of the road's s.
struct LaneOrigin {
  int section = 0;           ///< index of the lane section along the road; 0 elsewhere
  std::string source_id;     ///< "-1" in OpenDRIVE, the element's id elsewhere
  double road_from_s_m = 0;  ///< road s at the lane's start, in driving direction
  double road_to_s_m = 0;    ///< road s at the lane's end; less than the former against the road
};

/// The speed limit from a station on, until the next one begins.
struct SpeedLimit {
  double from_s_m = 0.0;
  std::optional<double> limit_mps;  ///< infinite: there is none; empty: the source says nothing
};

/// A strip between two borders, from one section end to the next.
struct Lane {
  LaneId id;
  std::optional<RoadId> road;          ///< none in Lanelet2 and CommonRoad
  std::optional<JunctionId> junction;  ///< the junction whose connecting road holds it
  LaneOrigin origin;
  std::string name;  ///< unique, as on the command line: "road/section/lane", or the source's id
  LaneType type = LaneType::none;
  bool one_way = true;                              ///< false: may be driven in both directions
  Participants participants;                        ///< who may use it
  std::vector<SpeedLimit> speed_limits;             ///< by station; empty: the source says nothing
  std::vector<BorderMark> left_marks, right_marks;  ///< by station; empty: unknown
  LaneLine left, centre, right;
  geometry::Ring polygon;  ///< simple and counter-clockwise; the borders' folds are taken out
  Attributes attributes;

  double length_m() const { return centre.in_map.length_m(); }

  /// The limit that holds at a station; infinite where the source says that there is none.
  std::optional<double> speed_limit_at_mps(double s_m) const;

  /// The least limit along the lane; empty where the source says nothing, or that there is none.
  std::optional<double> least_speed_limit_mps() const;

  /// Place on the centreline, clamped to the lane, with its direction over ±5 cm: records of real
  /// files do not meet exactly, and a step of a fraction of a millimetre has no direction.
  geometry::Pose2 pose_at(double s_m) const;

  /// Distance between the borders at a station [m].
  double width_m(double s_m) const;

  /// Border's point at a lane station, interpolated between its vertices' stations.
  static Eigen::Vector2d point_at(const LaneLine& line, double station_m);

  /// The elevation of a line at a lane station, likewise [m].
  static double height_at(const LaneLine& line, double station_m);
};

/// The polygon between a lane's borders, counter-clockwise and simple: of a ring that folds over
/// itself the largest part is kept. Empty if nothing of it has an area, or it folds without end.
geometry::Ring lane_ring(const geometry::Polyline& left_in_map,
                         const geometry::Polyline& right_in_map);

/// The same for any closed ring of points.
geometry::Ring simple_ring(geometry::Ring ring);

/// The same in two steps: the lane's ring, which may fold over itself, then its largest part.
/// @returns whether it folds: the second step then takes a thousand times longer.
bool lay_ring(Lane& lane);
void unfold_ring(Lane& lane);

/// Steps (geometry/primitives/work_limit.h) of unfolding, by point, and those that a file of that
/// size may ask for: some lanes of a spiral ramp of many storeys, and more in a longer file.
inline constexpr std::size_t kStepsPerFoldedPoint = 4;

constexpr std::size_t most_folding_steps(std::size_t file_bytes) {
  return geometry::most_steps(file_bytes / 500);
}

}  // namespace roadbed::map::elements
