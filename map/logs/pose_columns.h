#pragma once

// Private to map/logs: poses as the tables of Argoverse 2 hold them.

#include <Eigen/Geometry>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/logs/feather.h"

namespace roadbed::map::inline logs {

/// Names of the columns of a pose.
inline const std::vector<std::string> kPoseColumns = {"tx_m", "ty_m", "tz_m", "qw",
                                                      "qx",   "qy",   "qz"};

/// The poses of all rows, of the columns that kPoseColumns name, in that order.
/// @throws InputError if a column is whole, or a quaternion is no rotation to 1 %.
std::vector<Eigen::Isometry3d> poses_in(std::span<const FeatherColumn> columns,
                                        const std::string& name, const std::string& remedy);

/// @throws InputError if the column is not whole.
const std::vector<std::int64_t>& stamps_in(const FeatherColumn& column, const std::string& name,
                                           const std::string& remedy);

}  // namespace roadbed::map::logs
