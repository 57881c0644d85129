#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::tools::inline report {

/// Occupied space of a height band in plan view, as few boxes: cells of one row that touch are one
/// box, and so are equal boxes of rows that touch. Only what meets `box_in_source`. The boxes cover
/// exactly what the cells cover; they may overlap where cells have different sizes.
std::vector<map::Box2> occupied_in(const map::OccupancySource& occupancy,
                                   const map::HeightBand& band,
                                   const Eigen::AlignedBox2d& box_in_source);

/// The same from boxes of any kind.
std::vector<map::Box2> joined(std::vector<map::Box2> boxes);

}  // namespace roadbed::tools::report
