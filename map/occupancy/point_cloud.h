#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roadbed::map {

/// Measured points in the file's own coordinates, double, relative to a local origin.
struct PointCloud {
  Eigen::Vector3d origin_in_source{0, 0, 0};
  std::vector<Eigen::Vector3f> points;  ///< relative to the origin [m]
  std::string crs;                      ///< as the file says, may be empty
  std::size_t dropped_not_finite = 0;
  std::optional<Eigen::Vector3d> sensor_in_source;  ///< of the file's viewpoint, if it has one
};

/// Reads .pcd (ascii, binary, compressed), .ply, .las, .xyz; the format is told by content and
/// suffix; headers and sizes are checked before a library sees the bytes.
/// @throws InputError if the file is unusable or has no finite point.
PointCloud read_point_cloud(const std::filesystem::path& file);

}  // namespace roadbed::map
