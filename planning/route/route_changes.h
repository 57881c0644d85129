#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/planning/route/driven_lane.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline route {

/// The two lanes beside each other in one of the passages that a lane change takes.
struct ChangePart {
  std::size_t leg = 0;  ///< of the route, on one of both lanes
  DrivenLane from, to;
  double offset_m = 0.0;  ///< station of the left leg's lane at which the passage begins
};

/// The window of the change by which a leg is left, by stations in driving direction.
/// @pre there is one.
map::StationRange driven_window(const map::RoadMap& road_map, const RouteLeg& leg);

/// Passages of the change by which a leg is left: its own first, then those before it, back from
/// there, then those behind it. Stations are in driving direction. Empty for a leg that is left
/// otherwise.
std::vector<ChangePart> parts_of_change(const map::RoadMap& road_map, const Route& route,
                                        std::size_t leg);

}  // namespace roadbed::planning::route
