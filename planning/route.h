#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/road_map.h"

namespace roadbed::planning {

enum class RouteCost { time, distance };

struct RouteOptions {
  RouteCost cost = RouteCost::time;
  double default_speed_mps = 50.0 / 3.6;  ///< where the map gives no limit; its use is reported
  double max_speed_mps = 130.0 / 3.6;     ///< of the vehicle
  double lane_change_cost_s = 5.0;
  double least_lane_change_m = 10.0;  ///< length that a lane change needs
  std::vector<map::LaneId> avoid;     ///< lanes that are closed
};

/// How a leg of a route is left.
enum class LegExit { goal, successor, change_left, change_right };

/// A stretch of one lane.
struct RouteLeg {
  map::LaneId lane;
  double from_s_m = 0.0;
  double to_s_m = 0.0;  ///< where it is left; a change to a neighbour happens over the leg
  LegExit exit = LegExit::goal;
};

struct Route {
  std::vector<RouteLeg> legs;
  double cost_s = 0.0;    ///< or metres, by RouteOptions::cost
  double length_m = 0.0;  ///< along the centrelines, each stretch of road counted once
  int lane_changes = 0;
  int legs_of_unknown_speed = 0;
};

/// A route, or why there is none.
struct RouteAnswer {
  std::optional<Route> route;
  std::string reason;  ///< empty if there is a route
};

/// Cheapest lane-level route by A* over successors and permitted lane changes.
RouteAnswer find_route(const map::RoadMap& road_map, const map::LanePlace& from,
                       const map::LanePlace& to, const RouteOptions& options = {});

}  // namespace roadbed::planning
