#pragma once

#include <vector>

#include "roadbed/geometry/polygon.h"
#include "roadbed/map/road_map.h"

namespace roadbed::planning {

/// Lanes whose area has a point in common with the region, in order of id: a closed region closes
/// them as a whole. O(lanes · points).
std::vector<map::LaneId> lanes_touching(const map::RoadMap& road_map,
                                        const geometry::Ring& region_in_map);

}  // namespace roadbed::planning
