#include "roadbed/map/logs/argoverse_poses.h"

#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/feather.h"

namespace roadbed::map::inline logs {

std::vector<TimedPose> read_ego_poses(std::string_view bytes, const std::string& name) {
  const auto columns =
      parse_feather(bytes, name, {"timestamp_ns", "tx_m", "ty_m", "tz_m", "qw", "qx", "qy", "qz"});
  const auto refuse = [&](const std::string& element, const std::string& found,
                          const std::string& needed) {
    throw InputError({.file = name,
                      .element = element,
                      .found = found,
                      .needed = needed,
                      .remedy = "give city_SE3_egovehicle.feather"});
  };
  if (!columns[0].is_whole) refuse("column timestamp_ns", "is not whole", "nanoseconds");
  for (std::size_t c = 1; c < columns.size(); ++c) {
    if (columns[c].is_whole) refuse("column " + columns[c].name, "is whole", "real numbers");
  }
  std::vector<TimedPose> poses;
  for (std::size_t row = 0; row < columns[0].wholes.size(); ++row) {
    const auto value = [&](std::size_t c) { return columns[c].reals[row]; };
    const Eigen::Quaterniond turn(value(4), value(5), value(6), value(7));
    if (!(std::abs(turn.norm() - 1.0) <= 0.01)) {
      refuse("row " + std::to_string(row + 1), "has no rotation", "a quaternion of length 1");
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(value(1), value(2), value(3));
    poses.push_back({columns[0].wholes[row], pose});
  }
  return poses;
}

}  // namespace roadbed::map::logs
