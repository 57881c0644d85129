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

/// Of which frame the poses of a drive are: of base_link, where transforms say how the frame that a
/// topic of poses names stands to it; or of that frame itself.
enum class DriveFrame { vehicle, recorded };

/// Where a frame was at a time; none where that is not known.
using PoseAt = std::function<std::optional<Eigen::Isometry3d>(std::int64_t stamp_ns)>;

/// Where the frames of a log were, as far as it says: by its transforms; or, where these lead no
/// further than base_link, base_footprint or the frame of a topic of poses, by them on top of that
/// topic, whose frame is the one that Odometry names, else base_link.
class LogPoses {
 public:
  /// @param topic   the only one that counts; may be empty. Static transforms count always, with
  ///                poses all transforms.
  /// @param option  by which the user names it, for messages.
  LogPoses(std::string file, std::string topic, std::string option = "--pose-topic");

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

  /// The transforms by their topics; null if a topic of poses is asked for.
  const LogTransforms* transforms() const { return transforms_count_ ? &transforms_ : nullptr; }

  std::vector<std::string> pose_topics() const;

  /// Where the vehicle was by a topic of poses, at its stamps: in `map`, or as far up as transforms
  /// lead from the topic's frame. Stamps at which a transform is not known are left out, and said
  /// in a note; speeds where base_link does not stand straight ahead of the frame that the topic
  /// names.
  /// @pre the topic is one of `pose_topics()`.
  /// @throws InputError if it is of several frames, or a frame above has two parents.
  NotedPoses drive_by(const std::string& topic, DriveFrame frame) const;

 private:
  struct PoseTopic {
    std::string child, other_child;  ///< the last: of a topic that is of two frames
    TransformTree above;             ///< the child, and the transforms that go with it
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
  std::optional<std::vector<std::string>> way_to(const TransformTree& tree,
                                                 const std::string& frame,
                                                 const std::string& top) const;
  PoseAt body_in_child(const PoseTopic& poses) const;

  std::string file_, topic_, option_;
  LogTransforms transforms_;
  bool transforms_count_ = false;
  std::map<std::string, PoseTopic> by_topic_;
};

}  // namespace roadbed::map::logs
