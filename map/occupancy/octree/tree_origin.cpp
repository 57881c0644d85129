#include "roadbed/map/occupancy/octree/tree_origin.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/occupancy/octree/cell_key.h"

namespace roadbed::map::inline occupancy::inline octree {

Eigen::Vector3d tree_origin(const Box3& bounds, double resolution_m) {
  constexpr double near_zero_m = 4096.0;  // OctoMap computes in float
  const double range_m = std::min(near_zero_m, (kHalfRange - 1.0) * resolution_m);
  Eigen::Vector3d origin(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = bounds.min_in_source[axis], to = bounds.max_in_source[axis];
    if (std::max(-from, to) > range_m) origin[axis] = std::round(0.5 * (from + to));
  }
  return origin;
}

}  // namespace roadbed::map::occupancy::octree
