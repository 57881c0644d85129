#include "roadbed/map/logs/pose_columns.h"

#include <algorithm>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/log_messages.h"
#include "roadbed/map/logs/timed_pose.h"

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
    const Eigen::Vector3d position(value(0), value(1), value(2));
    if (const PoseFault fault = pose_fault(position, turn); !fault.found.empty()) {
      throw InputError({.file = name,
                        .element = "row " + std::to_string(row + 1),
                        .found = fault.found,
                        .needed = fault.needed,
                        .remedy = remedy});
    }
    poses.push_back(pose_of(position, turn));
  }
  return poses;
}

const std::vector<std::int64_t>& stamps_in(const FeatherColumn& column, const std::string& name,
                                           const std::string& remedy) {
  const auto wrong = std::ranges::find_if_not(column.wholes, is_usable_time);
  if (column.is_whole && wrong == column.wholes.end()) return column.wholes;
  throw InputError({.file = name,
                    .element = "column " + column.name,
                    .found = column.is_whole ? "is " + std::to_string(*wrong) : "is not whole",
                    .needed = "nanoseconds, before 2116",
                    .remedy = remedy});
}

}  // namespace roadbed::map::logs
