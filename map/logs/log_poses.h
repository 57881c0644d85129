#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/logs/log_transforms.h"
#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// Where a frame was at a time; none where that is not known.
using PoseAt = std::function<std::optional<Eigen::Isometry3d>(std::int64_t stamp_ns)>;

/// Where the frames of a log were, as far as it says: by its transforms; or, where these lead no
/// further than base_link, base_footprint or the frame of a topic of poses, by them on top of that
/// topic, whose frame is the one that Odometry names, else base_link.
class LogPoses {
 public:
  /// @param topic  the only one that counts; may be empty. Static transforms count always, below
  ///               poses all transforms.
  LogPoses(std::string file, std::string topic);

  /// A visitor of the log uses these two, then `finish`.
  bool wants(const LogTopic& topic) const;
  void take(const LogTopic& topic, const LogMessage& message);
  void finish();

  /// Valid as long as this is. None: the log does not say where the frame was.
  /// @throws InputError if several topics say it.
  PoseAt of(const std::string& frame) const;

  /// Where a frame was in base_link, by transforms; valid as long as this is. None: they do not
  /// say.
  PoseAt in_vehicle(const std::string& frame) const;

 private:
  struct PoseTopic {
    std::string child;
    TransformTree above;  ///< the child, and what holds for all times
    LogTransforms::Tree below;
  };
  /// A topic that says where a frame was, and the transforms that it goes with.
  struct Source {
    std::string topic;
    LogTransforms::Tree below;
    PoseAt at;
  };
  std::vector<Source> sources_of(const std::string& frame) const;
  bool ends_below_poses(const std::string& top) const;

  std::string file_, topic_;
  LogTransforms transforms_;
  bool transforms_count_ = false;
  std::map<std::string, PoseTopic> by_topic_;
};

}  // namespace roadbed::map::logs
