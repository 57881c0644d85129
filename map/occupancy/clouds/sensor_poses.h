#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline occupancy::inline clouds {

/// Reads poses of a sensor, a line each; blank lines and those that begin with # are left out. All
/// lines have the same form: eight numbers are TUM's `timestamp tx ty tz qx qy qz qw`, with
/// increasing times and quaternions of length 1 to within 1 %; twelve are KITTI's, the upper three
/// rows of the matrix from sensor to world, a rotation to within 1 %.
/// @throws InputError naming the line.
std::vector<Eigen::Isometry3d> read_sensor_poses(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
std::vector<Eigen::Isometry3d> parse_sensor_poses(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::occupancy::clouds
