#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/logs/pose_messages.h"
#include "roadbed/map/logs/transform_tree.h"

namespace roadbed::map::inline logs {

/// Where a frame was at a time; none where that is not known.
using PoseAt = std::function<std::optional<Eigen::Isometry3d>(std::int64_t stamp_ns)>;

/// Where the frames of a log were, as far as it says: by its transforms, else by its static ones on
/// top of one topic of poses, of the frame that Odometry names, else of base_link.
class LogPoses {
 public:
  /// @param topic  the only one that counts; may be empty. Static transforms count always.
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
  std::string file_, topic_;
  TransformTree transforms_;
  std::map<std::string, TransformTree> by_topic_;
};

}  // namespace roadbed::map::logs
