#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/logs/log_messages.h"
#include "roadbed/map/logs/timed_pose.h"

namespace roadbed::map::inline logs {

// What Foxglove's messages say of poses, in Protocol Buffers, and rows of roadbed's own.

/// foxglove.FrameTransform and FrameTransforms.
bool is_foxglove_transform_type(std::string_view type);
/// foxglove.PoseInFrame.
bool is_foxglove_pose_type(std::string_view type);

/// Reads one. @param file  for messages.
/// @throws InputError if it is cut off, or a quaternion is no rotation to within 1 %.
std::vector<FrameTransform> parse_foxglove_transforms(const LogTopic& topic,
                                                      const LogMessage& message,
                                                      const std::string& file);
PoseMessage parse_foxglove_pose(const LogTopic& topic, const LogMessage& message,
                                const std::string& file);

/// A row of a drive, `roadbed.DriveState`, as `McapWriter` put it in.
/// @throws InputError if it is cut off.
geometry::TrajectoryPoint parse_drive_state(const LogTopic& topic, const LogMessage& message,
                                            const std::string& file);

}  // namespace roadbed::map::logs
