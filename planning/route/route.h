#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_network.h"

namespace roadbed::planning::inline route {

/// How a leg of a route is left.
enum class LegExit { goal, successor, change_left, change_right };

/// A stretch of one lane. Where it is left to a neighbour, `to_s_m` is the middle of what the
/// change has of this lane. A lane of both directions may be driven against its own: then stations
/// fall, those of the window, too.
struct RouteLeg {
  map::LaneId lane;
  bool reversed = false;
  double from_s_m = 0.0;
  double to_s_m = 0.0;
  LegExit exit = LegExit::goal;
  Turn turn = Turn::none;  ///< of the lane
  /// Stations of the lane between which the change is made by which the leg is left: below 0, or
  /// above its length, where it begins beside a lane before or ends beside one behind.
  std::optional<map::StationRange> change_window;
  double length_m = 0.0;  ///< along the last lane of the lane group, so that lengths add up
  double cost_s = 0.0;    ///< of this leg, with the change that leaves it and the turn that it is
  double cost_m = 0.0;
  bool limit_known = true;  ///< everywhere on the lane
};

/// A place that a route was to pass.
struct RouteStop {
  std::size_t leg = 0;
  double s_m = 0.0;  ///< station of that leg's lane
};
/// A way over lanes, leg by leg, from its start to its goal.
struct Route {
  std::vector<RouteLeg> legs;
  double cost_s = 0.0;    ///< travel time at the limits, and manoeuvres: the sum of the legs'
  double cost_m = 0.0;    ///< length, and manoeuvres: the sum of the legs'
  double length_m = 0.0;  ///< along the centrelines; parallel lanes count once, as the last of them
  int lane_changes = 0;
  int legs_of_unknown_speed = 0;
  std::vector<RouteStop> stops;  ///< the places between start and goal, in order
};

}  // namespace roadbed::planning::route
