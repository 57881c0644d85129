#pragma once

#include <vector>

#include "roadbed/map/road_map.h"

namespace roadbed::map {

/// Drivable lanes in groups between which no link and no lane change leads, in either direction.
/// Largest group first, equal ones by their first lane; lanes in order of id. O(lanes + links).
std::vector<std::vector<LaneId>> drivable_components(const RoadMap& road_map);

}  // namespace roadbed::map
