#pragma once

#include <map>
#include <memory>
#include <string>

#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/transform_tree.h"

namespace roadbed::map::inline logs {

/// The transforms of a log by their topics, as the frames of several robots may have one name:
///
///     /robot1/tf ─┬─▶ a tree      /robot2/tf ─┬─▶ another      /robot2/odom ─┬─▶ below these poses
///     /robot1/tf_static           /robot2/tf_static            /robot2/tf, /robot2/tf_static
///
/// What holds for all times (topics that end with tf_static) goes with the topics in its namespace;
/// with one that is in no such namespace, all of it does.
class LogTransforms {
 public:
  using Tree = std::shared_ptr<const TransformTree>;

  static bool is_static(const LogTopic& topic) { return topic.name.ends_with("tf_static"); }

  /// @throws InputError as parse_transforms does.
  void take(const LogTopic& topic, const LogMessage& message, const std::string& file);

  /// After the last message.
  /// @param asked  a topic; of transforms that move it is the only one that counts. May be empty.
  /// @returns whether transforms count: none is asked for, or one of them.
  bool finish(const std::string& asked);

  /// Those of each topic that moves, by its name; all together where no frame stands in two topics.
  const std::map<std::string, Tree>& trees() const { return trees_; }

  /// Those that go with a topic of poses; of several topics that say the same frames none.
  Tree below(const std::string& pose_topic) const;

  /// Those that hold for all times and go with a topic.
  TransformTree static_of(const std::string& topic) const;

 private:
  std::map<std::string, TransformTree> moving_, static_;
  std::map<std::string, Tree> trees_;
  bool is_whole_ = false;
};

}  // namespace roadbed::map::logs
