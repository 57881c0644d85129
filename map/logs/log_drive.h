#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/logs/log_poses.h"
#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// The poses of one topic, at increasing stamps, in `map` where transforms lead there; of
/// roadbed.DriveState rows in their place, in the order of the file.
struct LogDrive {
  std::string topic;
  std::vector<TimedPose> poses = {};
  std::vector<geometry::TrajectoryPoint> rows = {};
  std::vector<std::string> notes = {};  ///< for users: which poses were left out, and why
  bool is_planned = false;              ///< times are not those at which poses were measured
};

/// The drive of a log: poses of Odometry, PoseStamped, PoseWithCovarianceStamped or
/// foxglove.PoseInFrame; what transforms say of the frame base_link (where there is none, of the
/// only one of that name in a namespace, else of base_footprint); a planned trajectory, NAME#K
/// for the K-th message, from 1; or rows of roadbed.DriveState. Planned ways without times get them
/// from their speeds, up to where it stands. Transforms of the log lead from the frame of poses up
/// to `map`, as they do for its clouds, and from the frame that Odometry names to base_link.
/// @param topic   may be empty where only one topic could be meant, or only one has rows.
/// @param option  by which the user names it, for messages.
/// @param frame   of Odometry whose child_frame_id is not base_link.
/// @throws InputError if there is none or there are several, which it lists.
LogDrive drive_of_log(const GoThrough& go_through, const std::string& file,
                      const std::string& topic, const std::string& option = "--topic",
                      DriveFrame frame = DriveFrame::vehicle);
LogDrive drive_of_log(const std::filesystem::path& path, const std::string& topic,
                      const std::string& option = "--topic",
                      DriveFrame frame = DriveFrame::vehicle);

}  // namespace roadbed::map::logs
