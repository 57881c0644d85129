#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The same cloud with every coordinate times `factor`, in metres and of no known CRS.
PointCloud scaled_to_metres(const PointCloud& cloud, double factor);

/// A cloud in its sensor's frame, moved to where the sensor stood: the sensor is at the pose's
/// origin, whatever viewpoint the file named; sensor positions of single points move along.
PointCloud placed(const PointCloud& cloud, const Eigen::Isometry3d& world_from_sensor);

/// A cloud in pieces that reach over some `side_m` along each axis at most, sensors included: what
/// was measured from nowhere in cubes from `origin_in_source` on, whole scans by where their
/// middles lie. A scan that reaches farther by itself is a piece of its own.
std::vector<PointCloud> split_cloud(const PointCloud& cloud,
                                    const Eigen::Vector3d& origin_in_source, double side_m);

}  // namespace roadbed::map::occupancy::clouds
