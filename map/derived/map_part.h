#pragma once

#include <Eigen/Geometry>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// The lanes of which a part may lie in a box, with their roads and junctions and what stands on or
/// beside them there, as a map of its own: in the whole's frame and order, ids counted anew. Links,
/// signals and regulations name the lanes that are kept, and no others. O(lanes kept + things).
RoadMap map_part(const RoadMap& whole, const Eigen::AlignedBox2d& box_in_map);

}  // namespace roadbed::map::derived
