#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/occupancy/point_cloud.h"

namespace roadbed::map {

/// A cloud in pieces that reach over some `side_m` along each axis at most, sensors included: what
/// was measured from nowhere in cubes from `origin_in_source` on, the rest in runs of whole scans.
/// One scan that reaches farther stays whole.
std::vector<PointCloud> cut_cloud(const PointCloud& cloud, const Eigen::Vector3d& origin_in_source,
                                  double side_m);

}  // namespace roadbed::map
