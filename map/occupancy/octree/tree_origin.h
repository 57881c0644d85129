#pragma once

#include <Eigen/Core>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Where the octree of clouds within such bounds has its origin: that of the source where the
/// octree's range allows it, else the middle.
Eigen::Vector3d tree_origin(const Box3& bounds, double resolution_m);

}  // namespace roadbed::map::occupancy::octree
