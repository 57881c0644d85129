#include "roadbed/map/logs/timed_pose.h"

#include <fmt/format.h>

#include <cmath>

namespace roadbed::map::inline logs {

PoseFault pose_fault(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn) {
  constexpr double farthest_m = 1e9, off = 0.01;
  if (!position.allFinite() || !(position.cwiseAbs().maxCoeff() < farthest_m)) {
    return {fmt::format("is at {}, {}, {}", position.x(), position.y(), position.z()),
            "a place on Earth"};
  }
  if (!(std::abs(turn.norm() - 1.0) <= off)) {
    return {fmt::format("has a quaternion of length {:.4g}", turn.norm()), "length 1"};
  }
  return {};
}

Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

}  // namespace roadbed::map::logs
