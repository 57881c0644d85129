#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline objects {

/// The unit normal of the surface at each point: of the plane through its nearest points (PCL's
/// NormalEstimation), turned towards the sensor, or upwards where it is not known where that was.
/// NaN where the points make no plane. O(N log N + N · neighbours).
/// @param neighbours  points of each plane, itself included, 3 or more.
/// @throws InputError if roadbed was built without PCL.
/// @pre the cloud holds a point, and is one scan.
std::vector<Eigen::Vector3f> normals(const PointCloud& cloud, int neighbours);

}  // namespace roadbed::map::occupancy::objects
