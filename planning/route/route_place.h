#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_network.h"

namespace roadbed::planning::inline route {

/// Which way a lane is driven at a place: as the lane runs, or against it, where that is allowed.
enum class Sense { either, along, against };

/// A place that a route starts at, passes or leads to.
struct RoutePlace : map::LanePlace {
  Sense sense = Sense::either;
  /// Other lanes that lie on this one there, as roads through a junction do where they fork or
  /// merge: the route takes whichever costs least.
  std::vector<map::LanePlace> or_on;

  RoutePlace() = default;
  RoutePlace(const map::LanePlace& place, Sense way = Sense::either)
      : map::LanePlace(place), sense(way) {}
  RoutePlace(map::LaneId on_lane, double at_s_m, double at_d_m = 0.0)
      : map::LanePlace{on_lane, at_s_m, at_d_m} {}
};

/// A place by a network's lane, and its station in driving direction.
struct NetworkPlace {
  std::uint32_t lane = 0;
  double s_m = 0.0;
};

/// The place on each of its lanes alone, with the same sense.
inline std::vector<RoutePlace> each_lane_of(const RoutePlace& place) {
  std::vector<RoutePlace> places{
      RoutePlace(static_cast<const map::LanePlace&>(place), place.sense)};
  for (const map::LanePlace& other : place.or_on) places.emplace_back(other, place.sense);
  return places;
}

/// The ways in which a place may be driven through: on each of its lanes one, or two if that has
/// both directions. Where a lane cannot be driven as asked, it is driven as it can be.
inline std::vector<NetworkPlace> ways_through(const RouteNetwork& network,
                                              const RoutePlace& place) {
  std::vector<NetworkPlace> ways;
  const auto add = [&](const map::LanePlace& on) {
    const std::uint32_t lane = on.lane.index, contraflow_twin = network.lanes[lane].contraflow_twin;
    if (place.sense != Sense::against || contraflow_twin == kNoLane) ways.push_back({lane, on.s_m});
    if (place.sense != Sense::along && contraflow_twin != kNoLane) {
      ways.push_back({contraflow_twin, network.lanes[lane].length_m - on.s_m});
    }
  };
  add(place);
  for (const map::LanePlace& other : place.or_on) add(other);
  return ways;
}

}  // namespace roadbed::planning::route
