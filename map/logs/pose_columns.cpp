#include "roadbed/map/logs/pose_columns.h"

#include <cmath>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {

std::vector<Eigen::Isometry3d> poses_in(std::span<const FeatherColumn> columns,
                                        const std::string& name, const std::string& remedy) {
  for (const FeatherColumn& column : columns) {
    if (!column.is_whole) continue;
    throw InputError({.file = name,
                      .element = "column " + column.name,
                      .found = "is whole",
                      .needed = "real numbers",
                      .remedy = remedy});
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t row = 0; row < columns[0].reals.size(); ++row) {
    const auto value = [&](std::size_t c) { return columns[c].reals[row]; };
    const Eigen::Quaterniond turn(value(3), value(4), value(5), value(6));
    if (!(std::abs(turn.norm() - 1.0) <= 0.01)) {
      throw InputError({.file = name,
                        .element = "row " + std::to_string(row + 1),
                        .found = "has no rotation",
                        .needed = "a quaternion of length 1",
                        .remedy = remedy});
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(value(0), value(1), value(2));
    poses.push_back(pose);
  }
  return poses;
}

const std::vector<std::int64_t>& stamps_in(const FeatherColumn& column, const std::string& name,
                                           const std::string& remedy) {
  if (column.is_whole) return column.wholes;
  throw InputError({.file = name,
                    .element = "column " + column.name,
                    .found = "is not whole",
                    .needed = "nanoseconds",
                    .remedy = remedy});
}

}  // namespace roadbed::map::logs
