#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/logs/log_drive.h"
#include "roadbed/map/logs/log_poses.h"
#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Which topics of a log are meant; either may be empty where only one could be.
struct LogCloudTopics {
  std::string clouds;
  std::string poses;  ///< of poses, or of transforms
};

/// What came of the messages of a topic.
struct LogCloudCounts {
  std::size_t clouds = 0;
  std::size_t without_point = 0;        ///< messages that hold no finite point, or none is left
  std::size_t without_pose = 0;         ///< messages left out: no point has a pose
  std::size_t points_without_pose = 0;  ///< in all messages
  std::size_t points_with_unlikely_times = 0;  ///< more than a second from their message's stamp
  std::size_t not_finite = 0, filtered_out = 0;
  std::vector<std::string> frames_as_they_stand;   ///< those without poses
  std::vector<std::string> frames_of_vehicle_box;  ///< not base_link, and nobody says where in it
  std::string untaken_time_field;                  ///< of times in an unknown unit; empty: none
};

/// The clouds of one topic of a log, PointCloud2 of ROS 2, one after the other, so that no more
/// than one is in memory. Each is placed by the poses of the same log, point by point where points
/// have times, and carves from its sensor; without poses of its frame it stands as it is. What lies
/// before the first pose, after the last or in a gap of them is left out.
class LogClouds {
 public:
  /// Goes through the log once, for its poses.
  /// @throws InputError as read_log does; if the topic is not there, or none is named and the log
  ///         has several, which it lists.
  LogClouds(const std::filesystem::path& log, LogCloudTopics topics);

  /// The same of a log that can be gone through again and again.
  LogClouds(GoThrough go_through, const std::string& file, LogCloudTopics topics);

  LogClouds(const LogClouds&) = delete;
  LogClouds& operator=(const LogClouds&) = delete;

  const std::string& topic() const { return topic_; }

  /// Goes through the log again. Each cloud has a point.
  /// @param filter  of which attributes and the vehicle's box, in base_link where transforms say
  ///                where the cloud's frame is in it, else in that frame, are looked at.
  /// @throws InputError if a message is damaged, or several topics say where its frame was.
  LogCloudCounts for_each(const std::function<void(PointCloud cloud)>& use,
                          const CloudFilter& filter = {}) const;

  /// What the user may want to know of the last time.
  std::vector<std::string> notes(const LogCloudCounts& counts) const;

 private:
  void look_through(const std::string& asked);

  GoThrough go_through_;
  std::string file_, topic_;
  LogPoses poses_;
};

}  // namespace roadbed::map::occupancy::clouds
