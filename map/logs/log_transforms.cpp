#include "roadbed/map/logs/log_transforms.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace roadbed::map::inline logs {
namespace {

bool is_in_namespace_of(const std::string& fellow, const std::string& topic) {
  return topic.starts_with(fellow.substr(0, fellow.rfind('/') + 1));
}

bool share_a_frame(const std::map<std::string, TransformTree>& by_topic) {
  std::set<std::string> seen;
  for (const auto& [name, tree] : by_topic) {
    for (const std::string& child : tree.children()) {
      if (!seen.insert(child).second) return true;
    }
  }
  return false;
}

}  // namespace

void LogTransforms::take(const LogTopic& topic, const LogMessage& message,
                         const std::string& file) {
  TransformTree& tree = (is_static(topic) ? static_ : moving_)[topic.name];
  for (const FrameTransform& transform : parse_transforms(topic, message, file)) {
    tree.add(transform, topic.name, is_static(topic));
  }
}

bool LogTransforms::finish(const std::string& asked) {
  for (auto* by_topic : {&moving_, &static_}) {
    for (auto& [name, tree] : *by_topic) {
      tree.sort();
      tree.hold_what_was_said_once();
    }
  }
  const bool is_one_asked = std::ranges::any_of(
      moving_, [&](const auto& entry) { return is_asked_as(entry.first, asked); });
  if (is_one_asked) keep_asked(moving_, asked);
  is_whole_ = !is_one_asked && !share_a_frame(moving_) && !share_a_frame(static_);
  if (is_whole_) {
    TransformTree all;
    for (auto* by_topic : {&moving_, &static_}) {
      for (auto& [name, tree] : *by_topic) all.merge(tree);
    }
    trees_[""] = std::make_shared<const TransformTree>(std::move(all));
  } else {
    for (auto& [name, tree] : moving_) {
      tree.merge(static_of(name));
      trees_[name] = std::make_shared<const TransformTree>(std::move(tree));
    }
  }
  moving_.clear();
  return asked.empty() || is_one_asked;
}

LogTransforms::Tree LogTransforms::below(const std::string& pose_topic) const {
  if (is_whole_) return trees_.begin()->second;
  std::vector<Tree> fellows;
  for (const auto& [name, tree] : trees_) {
    if (is_in_namespace_of(name, pose_topic)) fellows.push_back(tree);
  }
  if (fellows.size() == 1) return fellows.front();
  return std::make_shared<const TransformTree>(static_of(pose_topic));
}

TransformTree LogTransforms::static_of(const std::string& topic) const {
  const auto goes_with_it = [&](const auto& entry) {
    return is_in_namespace_of(entry.first, topic);
  };
  const bool has_own = std::ranges::any_of(static_, goes_with_it);
  TransformTree found;
  for (const auto& entry : static_) {
    if (!has_own || goes_with_it(entry)) found.merge(entry.second);
  }
  return found;
}

}  // namespace roadbed::map::logs
