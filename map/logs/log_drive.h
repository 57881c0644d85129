#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// The poses of one topic, at increasing stamps.
struct LogDrive {
  std::string topic;
  std::vector<TimedPose> poses;
};

/// A log to go through, once.
using GoThrough = std::function<void(const LogVisitor&)>;

/// The drive of a log: poses of Odometry, PoseStamped or PoseWithCovarianceStamped; what transforms
/// say of the frame base_link; or a planned trajectory, NAME#K for the K-th message, from 1.
/// Planned ways without times get them from their speeds.
/// @param topic  may be empty where only one topic could be meant.
/// @throws InputError if there is none or there are several, which it lists.
LogDrive drive_of_log(const GoThrough& go_through, const std::string& file,
                      const std::string& topic);
LogDrive drive_of_log(const std::filesystem::path& path, const std::string& topic);

}  // namespace roadbed::map::logs
