#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline route {

/// Where in its window one lane change of a route is made, in place of the middle.
struct PlacedChange {
  std::size_t leg = 0;  ///< that the change leaves
  enum class At { window_start, window_end } at = At::window_start;
  double length_m = 40.0;  ///< that it takes, where there is room
};

struct RoutePathOptions {
  double step_m = 0.5;
  double lane_change_length_m = 40.0;
  std::optional<PlacedChange> placed_change = {};  ///< none: all in the middle of their windows
  double lead_m = 10.0;    ///< of the first lane behind the start, as far as there is some
  double extend_m = 30.0;  ///< past the goal
};

/// A place on the way, and the lane that it belongs to.
struct RoutePathPoint {
  Eigen::Vector2d in_map{0, 0};
  map::LaneId lane;
  double fraction = 0.0;  ///< of the lane's length, in driving direction
  bool reversed = false;  ///< driven against the lane's direction
};

/// The centrelines of a route one behind the other, before smoothing.
struct RoutePath {
  std::vector<RoutePathPoint> points;
  double start_m = 0.0;  ///< length of the path up to the route's start
  double goal_m = 0.0;   ///< and up to its goal
};

/// Samples a route. At a lane change the path passes over by 10t³ − 15t⁴ + 6t⁵, the quintic that
/// begins and ends without slope and curvature, over `lane_change_length_m` or the room that there
/// is, over section ends, too. Where a lane begins beside the end of the one before by more than 5
/// cm, the step is taken out in the same way over the first metres of the lane. Past the goal it
/// follows the straightest successors, then goes on straight.
RoutePath path_along(const map::RoadMap& road_map, const Route& route,
                     const RoutePathOptions& options);

}  // namespace roadbed::planning::route
