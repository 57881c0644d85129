#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/cdr.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/timed_pose.h"

namespace roadbed::map::inline logs {

/// std_msgs/msg/Header.
struct MessageHeader {
  std::int64_t stamp_ns;  ///< where that is 0, when the message was recorded
  std::string frame;
};

/// A planned way: poses from its start on.
struct PlannedTrajectory {
  std::string frame;
  std::vector<TimedPose> points;  ///< `stamp_ns` counts from the start
};

/// Whether messages of a type say one pose each: nav_msgs Odometry, geometry_msgs PoseStamped and
/// PoseWithCovarianceStamped, foxglove.PoseInFrame.
bool is_pose_type(std::string_view type);
/// tf2_msgs TFMessage, foxglove.FrameTransform and FrameTransforms.
bool is_transform_type(std::string_view type);
/// Trajectory of autoware_planning_msgs and autoware_auto_planning_msgs.
bool is_trajectory_type(std::string_view type);

/// What messages of a type have to be encoded as: protobuf for those of Foxglove, else cdr.
std::string_view encoding_of(std::string_view type);

/// Takes the header off a message.
MessageHeader read_header(Cdr& cdr, std::int64_t received_ns);

/// Reads one. @param file  for messages.
/// @throws InputError if it is cut off, or a quaternion is no rotation to within 1 %.
PoseMessage parse_pose(const LogTopic& topic, const LogMessage& message, const std::string& file);
std::vector<FrameTransform> parse_transforms(const LogTopic& topic, const LogMessage& message,
                                             const std::string& file);
PlannedTrajectory parse_planned(const LogMessage& message, const std::string& file);

}  // namespace roadbed::map::logs
