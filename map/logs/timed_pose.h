#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

namespace roadbed::map::inline logs {

/// Where something was at a time.
struct TimedPose {
  std::int64_t stamp_ns;   ///< of the message's header; where that is 0, when it was recorded
  Eigen::Isometry3d pose;  ///< in the frame
  std::optional<double> speed_mps = {};  ///< ahead
};

/// A message that says one pose.
struct PoseMessage {
  TimedPose at;
  std::string frame;
  std::string child;  ///< the frame whose pose it is, where the message says so
};

/// A transform of `/tf`.
struct FrameTransform {
  std::string parent, child;
  TimedPose child_in_parent;
};

/// What is wrong with a pose, if anything is: it is far from Earth, or does not turn.
struct PoseFault {
  std::string found = {}, needed = {};  ///< empty: nothing is
};
PoseFault pose_fault(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn);

/// @pre there is no fault
Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn);

}  // namespace roadbed::map::logs
