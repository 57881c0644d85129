#pragma once

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// What to take out of a cloud before occupancy is built from it.
struct CloudFilter {
  double voxel_m = 0.0;             ///< one point, the mean, per cube of this side; 0: keep all
  int outlier_neighbours = 0;       ///< compare distances to this many neighbours; 0: keep all
  double outlier_deviations = 2.0;  ///< over the mean by more standard deviations: an outlier

  bool does_something() const { return voxel_m > 0.0 || outlier_neighbours > 0; }
};

/// Applies PCL's StatisticalOutlierRemoval, then its VoxelGrid. PCL is opened now, not when the
/// program starts, which would cost every command 50 ms.
/// @throws InputError if roadbed was built without PCL, or no point is left.
PointCloud filtered(const PointCloud& cloud, const CloudFilter& filter);

}  // namespace roadbed::map::occupancy::clouds
