#pragma once

#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// Which border of its first section each road's reference line follows: the one in the middle, but
/// roads that are linked without a junction have theirs begin where the other one's ends.
std::vector<std::size_t> reference_borders(const RoadMap& road_map, const RoadPlan& plan);

}  // namespace roadbed::map::opendrive
