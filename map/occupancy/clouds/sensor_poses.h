#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Reads poses of a sensor, a line each; blank lines and those that begin with # are left out. All
/// lines have the same form: eight numbers are TUM's `timestamp tx ty tz qx qy qz qw`, with
/// increasing times and quaternions of length 1 to within 1 %; twelve are KITTI's, the upper three
/// rows of the matrix from sensor to world, a rotation to within 1 %.
/// @throws InputError naming the line.
std::vector<Eigen::Isometry3d> read_sensor_poses(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
std::vector<Eigen::Isometry3d> parse_sensor_poses(std::string_view bytes, const std::string& name);

/// A cloud in its sensor's frame, moved to where the sensor stood: the sensor is at the pose's
/// origin, whatever viewpoint the file named; sensor positions of single points move along.
PointCloud placed(const PointCloud& cloud, const Eigen::Isometry3d& world_from_sensor);

}  // namespace roadbed::map::occupancy::clouds
