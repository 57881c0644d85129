#pragma once

#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline route {

/// Lanes whose area has a point in common with the region, in order of id: a closed region closes
/// them as a whole. O(lanes · points).
std::vector<map::LaneId> lanes_touching(const map::RoadMap& road_map,
                                        const geometry::Ring& region_in_map);

}  // namespace roadbed::planning::route
