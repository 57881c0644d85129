#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline octree {

/// A cloud in pieces that reach over some `side_m` along each axis at most, sensors included: what
/// was measured from nowhere in cubes from `origin_in_source` on, whole scans by where their
/// middles lie. A scan that reaches farther by itself is a piece of its own.
std::vector<PointCloud> split_cloud(const PointCloud& cloud,
                                    const Eigen::Vector3d& origin_in_source, double side_m);

}  // namespace roadbed::map::occupancy::octree
