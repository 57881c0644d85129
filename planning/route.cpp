#include "roadbed/planning/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/planning/route_obstacle.h"
#include "roadbed/planning/route_search.h"

namespace roadbed::planning {
namespace {

constexpr double kStationSlack_m = 1e-6;

void check(const map::RoadMap& road_map, const map::LanePlace& place, const char* what) {
  if (place.lane.index >= road_map.lanes().size()) {
    throw std::invalid_argument(fmt::format("find_route: the {} names no lane of the map", what));
  }
  const map::Lane& lane = road_map.lane(place.lane);
  if (!(place.s_m >= -kStationSlack_m && place.s_m <= lane.length_m() + kStationSlack_m)) {
    throw std::invalid_argument(
        fmt::format("find_route: the {} is at {} m of lane {}, which is {} m long", what, place.s_m,
                    lane.name, lane.length_m()));
  }
}

std::string unfit(const map::Lane& lane, const char* what) {
  return fmt::format("the {} is on lane {}, where a car may not drive: its type is {}", what,
                     lane.name, map::name(lane.type));
}

LegExit side_of(const map::LaneLinks& links, map::LaneId to) {
  return links.left && links.left->lane == to ? LegExit::change_left : LegExit::change_right;
}

// Each of k changes has a k-th of the passage, and happens in the middle of it.
double fraction_left(const Passage& passage, std::size_t leg) {
  const std::size_t changes = passage.lanes.size() - 1;
  if (leg == changes) return passage.to;
  const double share = (static_cast<double>(leg) + 0.5) / static_cast<double>(changes);
  return std::lerp(passage.from, passage.to, share);
}

void add_passage(Route& route, const Passage& passage, const map::RoadMap& road_map, bool last) {
  for (std::size_t i = 0; i < passage.lanes.size(); ++i) {
    const map::Lane& lane = road_map.lane(passage.lanes[i]);
    const double from = i == 0 ? passage.from : fraction_left(passage, i - 1);
    RouteLeg leg{lane.id, from * lane.length_m(), fraction_left(passage, i) * lane.length_m(),
                 last ? LegExit::goal : LegExit::successor};
    if (i + 1 < passage.lanes.size()) {
      leg.exit = side_of(road_map.graph().of(lane.id), passage.lanes[i + 1]);
    }
    route.legs.push_back(leg);
    route.legs_of_unknown_speed += lane.least_speed_limit_mps() ? 0 : 1;
  }
}

// What a passage costs by one measure.
double cost_of(const Passage& passage, const TravelRules& rules) {
  double cost = rules.travel_cost(passage.lanes.back(), passage.to - passage.from);
  const double share = 1.0 - passage.from;  // as the search prices it, also where the goal is in it
  for (std::size_t i = 0; i + 1 < passage.lanes.size(); ++i) {
    cost += rules.change_cost(passage.lanes[i], static_cast<int>(i), share);
  }
  return cost;
}

Route assemble(const std::vector<Passage>& passages, const map::RoadMap& road_map,
               const RouteOptions& options) {
  RouteOptions by_time = options, by_distance = options;
  by_time.cost = RouteCost::time;
  by_distance.cost = RouteCost::distance;
  const TravelRules time(road_map, by_time, {}), distance(road_map, by_distance, {});
  Route route;
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const Passage& passage = passages[i];
    add_passage(route, passage, road_map, i + 1 == passages.size());
    route.cost_s += cost_of(passage, time);
    route.cost_m += cost_of(passage, distance);
    route.length_m += (passage.to - passage.from) * road_map.lane(passage.lanes.back()).length_m();
    route.lane_changes += static_cast<int>(passage.lanes.size()) - 1;
  }
  return route;
}

}  // namespace

RouteAnswer find_route(const map::RoadMap& road_map, const map::LanePlace& from,
                       const map::LanePlace& to, const RouteOptions& options) {
  check(road_map, from, "start");
  check(road_map, to, "goal");
  const map::Lane& start = road_map.lane(from.lane);
  const map::Lane& goal = road_map.lane(to.lane);
  if (!is_drivable(start.type)) return {std::nullopt, unfit(start, "start"), std::nullopt};
  if (!is_drivable(goal.type)) return {std::nullopt, unfit(goal, "goal"), std::nullopt};
  const SearchResult result = search(TravelRules(road_map, options, {}), from, to);
  if (result.passages) return {assemble(*result.passages, road_map, options), "", std::nullopt};
  const RouteObstacle obstacle = find_obstacle(road_map, from, to, options, result.reached);
  return {std::nullopt, describe(road_map, from, to, obstacle), obstacle};
}

}  // namespace roadbed::planning
