#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/planning/route.h"

namespace roadbed::planning {

/// The two lanes beside each other in one of the passages that a lane change takes.
struct ChangePart {
  std::size_t leg = 0;  ///< of the route, on one of both lanes
  map::LaneId from, to;
  double offset_m = 0.0;  ///< station of the left leg's lane at which the passage begins
};

/// Passages of the change by which a leg is left: its own first, then those before it, back from
/// there, then those behind it. Empty for a leg that is left otherwise.
std::vector<ChangePart> parts_of_change(const map::RoadMap& road_map, const Route& route,
                                        std::size_t leg);

}  // namespace roadbed::planning
