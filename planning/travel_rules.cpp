#include "roadbed/planning/travel_rules.h"

#include <algorithm>

namespace roadbed::planning {

double route_speed_mps(const map::Lane& lane, const RouteOptions& options) {
  const double limit_mps = lane.least_speed_limit_mps().value_or(options.default_speed_mps);
  return std::min(limit_mps > 0.0 ? limit_mps : options.default_speed_mps, options.max_speed_mps);
}

TravelRules::TravelRules(const map::RoadMap& road_map, const RouteOptions& options,
                         Leniency leniency)
    : road_map_(road_map), options_(options), leniency_(leniency) {
  for (const map::Lane& lane : road_map.lanes()) open_.push_back(is_drivable(lane.type));
  if (leniency.closed_lanes) return;
  for (const map::LaneId lane : options.avoid) open_.at(lane.index) = false;
}

bool TravelRules::may_change(map::LaneId from, const map::Neighbour& to, int changes,
                             double share) const {
  return to.same_direction && (to.change_allowed() || leniency_.markings) && may_enter(to.lane) &&
         has_room(from, changes + 1, share);
}

bool TravelRules::has_room(map::LaneId lane, int changes, double share) const {
  const double room_m = share * road_map_.lane(lane).length_m();
  return changes == 0 || leniency_.length || changes * options_.least_lane_change_m <= room_m;
}

double TravelRules::travel_cost(map::LaneId id, double share) const {
  const map::Lane& lane = road_map_.lane(id);
  const double length_m = share * lane.length_m();
  return options_.cost == RouteCost::distance ? length_m
                                              : length_m / route_speed_mps(lane, options_);
}

double TravelRules::change_cost(map::LaneId from, int changes, double share) const {
  const double cost = options_.cost == RouteCost::distance ? options_.lane_change_cost_m
                                                           : options_.lane_change_cost_s;
  const double room_m = share * road_map_.lane(from).length_m() / (changes + 1);
  return cost * std::max(1.0, options_.comfortable_lane_change_m / room_m);
}

}  // namespace roadbed::planning
