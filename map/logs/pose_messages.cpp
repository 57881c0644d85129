#include "roadbed/map/logs/pose_messages.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "roadbed/map/logs/cdr.h"
#include "roadbed/map/logs/foxglove_poses.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::string_view kOdometry = "nav_msgs/msg/Odometry",
                           kPose = "geometry_msgs/msg/PoseStamped",
                           kPoseWithCovariance = "geometry_msgs/msg/PoseWithCovarianceStamped",
                           kTransforms = "tf2_msgs/msg/TFMessage",
                           kTrajectory = "autoware_planning_msgs/msg/Trajectory",
                           kOldTrajectory = "autoware_auto_planning_msgs/msg/Trajectory";

std::int64_t read_time(Cdr& cdr) {
  const auto seconds = static_cast<std::int64_t>(cdr.number<std::int32_t>());
  return seconds * 1'000'000'000 + static_cast<std::int64_t>(cdr.number<std::uint32_t>());
}

Eigen::Isometry3d read_isometry(Cdr& cdr) {
  Eigen::Vector3d position;
  for (double& value : position) value = cdr.number<double>();
  Eigen::Quaterniond turn;
  for (double& value : turn.coeffs()) value = cdr.number<double>();  // x, y, z, w
  if (const PoseFault fault = pose_fault(position, turn); !fault.found.empty()) {
    cdr.refuse(fault.found, fault.needed);
  }
  return pose_of(position, turn);
}

}  // namespace

bool is_pose_type(std::string_view type) {
  return type == kOdometry || type == kPose || type == kPoseWithCovariance ||
         is_foxglove_pose_type(type);
}
bool is_transform_type(std::string_view type) {
  return type == kTransforms || is_foxglove_transform_type(type);
}
bool is_trajectory_type(std::string_view type) {
  return type == kTrajectory || type == kOldTrajectory;
}

std::string_view encoding_of(std::string_view type) {
  const bool is_protobuf = type.starts_with("foxglove.") || type.starts_with("roadbed.");
  return is_protobuf ? "protobuf" : "cdr";
}

MessageHeader read_header(Cdr& cdr, std::int64_t received_ns) {
  const std::int64_t stamp_ns = read_time(cdr);
  return {stamp_ns == 0 ? received_ns : stamp_ns, cdr.text()};
}

PoseMessage parse_pose(const LogTopic& topic, const LogMessage& message, const std::string& file) {
  if (is_foxglove_pose_type(topic.type)) return parse_foxglove_pose(topic, message, file);
  Cdr cdr(message.bytes, file, topic.name + ", " + message.place);
  const MessageHeader header = read_header(cdr, message.received_ns);
  std::string child = topic.type == kOdometry ? cdr.text() : std::string();
  PoseMessage read{{header.stamp_ns, read_isometry(cdr)}, header.frame, std::move(child)};
  if (topic.type == kOdometry) {
    for (int i = 0; i < 36; ++i) cdr.number<double>();
    const auto ahead_mps = cdr.number<double>();
    if (std::isfinite(ahead_mps)) read.at.speed_mps = ahead_mps;
  }
  return read;
}

std::vector<FrameTransform> parse_transforms(const LogTopic& topic, const LogMessage& message,
                                             const std::string& file) {
  if (is_foxglove_transform_type(topic.type)) {
    return parse_foxglove_transforms(topic, message, file);
  }
  constexpr std::size_t least_bytes = 72;
  Cdr cdr(message.bytes, file, message.place);
  std::vector<FrameTransform> transforms(cdr.count(least_bytes));
  for (FrameTransform& transform : transforms) {
    const MessageHeader header = read_header(cdr, message.received_ns);
    transform.parent = header.frame;
    transform.child = cdr.text();
    transform.child_in_parent = {header.stamp_ns, read_isometry(cdr)};
  }
  return transforms;
}

PlannedTrajectory parse_planned(const LogMessage& message, const std::string& file) {
  constexpr std::size_t least_bytes = 88;
  Cdr cdr(message.bytes, file, message.place);
  PlannedTrajectory planned{read_header(cdr, message.received_ns).frame, {}};
  planned.points.resize(cdr.count(least_bytes));
  for (TimedPose& point : planned.points) {
    point.stamp_ns = read_time(cdr);
    point.pose = read_isometry(cdr);
    point.speed_mps = static_cast<double>(cdr.number<float>());
    for (int i = 0; i < 5; ++i) cdr.number<float>();  // sideways, acceleration, turning, wheels
  }
  return planned;
}

}  // namespace roadbed::map::logs
