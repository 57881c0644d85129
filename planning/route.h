#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/road_map.h"

namespace roadbed::planning {

enum class RouteCost { time, distance };

struct RouteOptions {
  RouteCost cost = RouteCost::time;
  double default_speed_mps = 50.0 / 3.6;    ///< where the map gives no limit; its use is reported
  double max_speed_mps = 130.0 / 3.6;       ///< of the vehicle
  double lane_change_cost_s = 5.0;          ///< each, where there is comfortable room
  double lane_change_cost_m = 50.0;         ///< the same where distance is the cost
  double least_lane_change_m = 10.0;        ///< length that a lane change needs
  double comfortable_lane_change_m = 40.0;  ///< with less room its cost grows in proportion
  std::vector<map::LaneId> avoid;           ///< lanes that are closed
};

/// How a leg of a route is left.
enum class LegExit { goal, successor, change_left, change_right };

/// A stretch of one lane. Where it is left to a neighbour, `to_s_m` is the middle of the change:
/// half of it is still before that place, as far as there is room.
struct RouteLeg {
  map::LaneId lane;
  double from_s_m = 0.0;
  double to_s_m = 0.0;
  LegExit exit = LegExit::goal;
};

struct Route {
  std::vector<RouteLeg> legs;
  double cost_s = 0.0;    ///< travel time at the limits, and lane changes
  double cost_m = 0.0;    ///< length, and lane changes
  double length_m = 0.0;  ///< along the centrelines; parallel lanes count once, as the last of them
  int lane_changes = 0;
  int legs_of_unknown_speed = 0;
};

/// What stands between a start and a goal that no route connects.
struct RouteObstacle {
  std::size_t lanes_from_start = 0;  ///< that can be reached
  std::size_t lanes_to_goal = 0;     ///< from which the goal can be reached
  double gap_m = 0.0;                ///< least distance from an end of those to a start of these
  std::optional<map::LaneId> gap_from, gap_to;
  bool closed_lanes = false;  ///< with them open there would be a route
  bool markings = false;      ///< with every marking crossed there would be one
  bool length = false;        ///< with shorter lane changes there would be one
};

/// A route, or why there is none.
struct RouteAnswer {
  std::optional<Route> route;
  std::string reason;                     ///< one line; empty if there is a route
  std::optional<RouteObstacle> obstacle;  ///< none if start or goal themselves are unfit
};

/// Cheapest lane-level route over successors and permitted lane changes, by A*.
///
/// Between two section ends, parallel lanes form one passage: it is driven along its share of each
/// lane, and changes cost extra wherever in it they happen. The k-th change of a passage needs k
/// times `least_lane_change_m` of the lane that it leaves. A passage costs what its last lane
/// costs. Closed lanes are entered nowhere, but a start on one may be left. Of equally cheap routes
/// the one with the lower lane ids is taken. About 1 ms for 1,000 lanes.
///
/// A* is guided by the straight-line distance times the least cost per metre that any link of the
/// map has, so that it is right on maps with gaps, too.
/// @throws std::invalid_argument if a lane is not in the map or a station not on its lane.
RouteAnswer find_route(const map::RoadMap& road_map, const map::LanePlace& from,
                       const map::LanePlace& to, const RouteOptions& options = {});

}  // namespace roadbed::planning
