#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_point.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/route/route_path.h"

namespace roadbed::planning::inline reference {

struct ReferenceLineData;
/// How a reference line is laid.
struct ReferenceLineOptions {
  double step_m = 0.5;                 ///< between support points
  double max_smoothing_m = 0.3;        ///< largest move off the centreline, or of a way-point
  double max_curvature_per_m = 0.2;    ///< the vehicle can steer
  double lane_change_length_m = 40.0;  ///< a lane change takes, where there is room
  std::optional<PlacedChange> placed_change = {};  ///< not made in the middle of its window
  double default_speed_mps = 50.0 / 3.6;
  double extend_m = 30.0;  ///< how far the line goes on past the goal
  /// Who is to drive along it. Corners of way-points are rounded for it at the speed below (none:
  /// by 14 m); bends of a route that it cannot steer are rounded as far as its body has the room,
  /// and what remains is noted.
  std::optional<geometry::VehicleShape> corner_vehicle = std::nullopt;
  double corner_speed_mps = 0.0;
};

/// A smooth line to drive along: position, heading, κ, κ′, κ″, κ‴ and κ⁗ are continuous and exact
/// derivatives of one curve (geometry/curves/smooth_curve.h). Immutable; `s` is true arc length.
class ReferenceLine {
 public:
  /// Through way-points (not along a route): cubic spline, resampled, corners rounded by quintic
  /// Bézier curves (way_point_path.h), then made smooth within `max_smoothing_m`. The corridor is
  /// `half_width_m` on both sides. The goal is the last way-point.
  /// @throws std::invalid_argument for fewer than two distinct way-points, one not finite, or a way
  ///         of more than kMostSupportPoints steps.
  static ReferenceLine through(const std::vector<Eigen::Vector2d>& way_points_in_map,
                               double half_width_m, double speed_limit_mps,
                               const ReferenceLineOptions& options = {});

  /// Along a route, lane changes included, from its start to `extend_m` past its goal.
  /// @throws map::InputError for a route of more than kMostSupportPoints steps.
  static ReferenceLine along(const map::RoadMap& road_map, const Route& route,
                             const ReferenceLineOptions& options = {});

  double length_m() const;

  /// Station of the route's goal, at most length_m().
  double goal_s_m() const;

  /// Point at `s_m`. Past the end the line goes on straight; before 0 it follows the lane's first
  /// metres behind the start, where there are any, then goes on straight. O(log N), a few µs.
  ReferencePoint at(double s_m) const;

  /// Room and speed limit at `s_m`, clamped to the line.
  Corridor corridor_at(double s_m) const;

  /// Foot of the perpendicular from a point: of the whole line, O(N); with `near_s_m` the nearest
  /// one downhill from there, O(1). Before and past the line s is that of its straight extensions.
  geometry::LinePosition project(const Eigen::Vector2d& point_in_map,
                                 std::optional<double> near_s_m = std::nullopt) const;

  /// Largest distance of a way-point that is no corner, or of the centreline, from the line [m].
  double largest_move_m() const;

  /// Corners of way-points, and stretches of a route, that cannot be driven as asked; a line
  /// of text for each.
  const std::vector<std::string>& notes() const;

 private:
  explicit ReferenceLine(std::shared_ptr<const ReferenceLineData> data);
  std::shared_ptr<const ReferenceLineData> data_;
};

/// What lateral planning asks of a reference line: its geometry and the room beside it. Made from
/// a ReferenceLine, or from any two functions, such as those of an analytic line.
class LineView {
 public:
  LineView(const ReferenceLine& line)  // NOLINT: a ReferenceLine may stand for its view
      : at_([line](double s_m) { return line.at(s_m); }),
        corridor_at_([line](double s_m) { return line.corridor_at(s_m); }) {}
  LineView(std::function<ReferencePoint(double)> at, std::function<Corridor(double)> corridor_at)
      : at_(std::move(at)), corridor_at_(std::move(corridor_at)) {}
  /// As those of a ReferenceLine.
  ReferencePoint at(double s_m) const { return at_(s_m); }
  Corridor corridor_at(double s_m) const { return corridor_at_(s_m); }  ///< the same

 private:
  std::function<ReferencePoint(double)> at_;
  std::function<Corridor(double)> corridor_at_;
};

}  // namespace roadbed::planning::reference
