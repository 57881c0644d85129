#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/cdr.h"
#include "roadbed/map/logs/log.h"

namespace roadbed::map::inline logs {

/// Where something was at a time.
struct TimedPose {
  std::int64_t stamp_ns;   ///< of the message's header; where that is 0, when it was recorded
  Eigen::Isometry3d pose;  ///< in the frame
  std::optional<double> speed_mps = {};  ///< ahead
};

/// std_msgs/msg/Header.
struct MessageHeader {
  std::int64_t stamp_ns;  ///< where that is 0, when the message was recorded
  std::string frame;
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

/// A planned way: poses from its start on.
struct PlannedTrajectory {
  std::string frame;
  std::vector<TimedPose> points;  ///< `stamp_ns` counts from the start
};

/// Whether messages of a type say one pose each: nav_msgs Odometry, geometry_msgs PoseStamped and
/// PoseWithCovarianceStamped.
bool is_pose_type(std::string_view type);
/// tf2_msgs TFMessage.
bool is_transform_type(std::string_view type);
/// Trajectory of autoware_planning_msgs and autoware_auto_planning_msgs.
bool is_trajectory_type(std::string_view type);

/// Takes the header off a message.
MessageHeader read_header(Cdr& cdr, std::int64_t received_ns);

/// Reads one. @param file  for messages.
/// @throws InputError if it is cut off, or a quaternion is no rotation to within 1 %.
PoseMessage parse_pose(const LogTopic& topic, const LogMessage& message, const std::string& file);
std::vector<FrameTransform> parse_transforms(const LogMessage& message, const std::string& file);
PlannedTrajectory parse_planned(const LogMessage& message, const std::string& file);

}  // namespace roadbed::map::logs
