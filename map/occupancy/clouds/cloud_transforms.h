#pragma once

#include <Eigen/Geometry>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The same cloud with every coordinate times `factor`, in metres and of no known CRS.
PointCloud scaled_to_metres(const PointCloud& cloud, double factor);

/// A cloud in its sensor's frame, moved to where the sensor stood: the sensor is at the pose's
/// origin, whatever viewpoint the file named; sensor positions of single points move along.
PointCloud placed(const PointCloud& cloud, const Eigen::Isometry3d& world_from_sensor);

}  // namespace roadbed::map::occupancy::clouds
