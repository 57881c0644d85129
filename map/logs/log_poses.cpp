#include "roadbed/map/logs/log_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {
namespace {

constexpr const char *kVehicle = "base_link", *kOption = "--pose-topic";

/// With whatever namespace in front.
bool is_of_vehicle(const std::string& frame) {
  const std::string name = frame.substr(frame.rfind('/') + 1);
  return name == kVehicle || name == "base_footprint";
}

using Way = std::vector<std::string>;

/// From a frame up to another one; none where that is not above it.
std::optional<Way> way_to(const TransformTree& tree, const std::string& frame,
                          const std::string& top, const std::string& file) {
  Way way = tree.way_up(frame, file, kOption, top);
  const std::string& reached = way.empty() ? frame : tree.parent_of(way.back());
  return reached == top ? std::optional(std::move(way)) : std::nullopt;
}

PoseAt along(LogTransforms::Tree tree, Way way) {
  return [tree = std::move(tree), way = std::move(way)](std::int64_t stamp_ns) {
    return tree->at(way, stamp_ns);
  };
}

PoseAt along(const TransformTree& above, Way up, LogTransforms::Tree below, Way way) {
  return [&above, up = std::move(up), in_child = along(std::move(below), std::move(way))](
             std::int64_t stamp_ns) -> std::optional<Eigen::Isometry3d> {
    const auto child = above.at(up, stamp_ns), frame = in_child(stamp_ns);
    if (!child || !frame) return std::nullopt;
    return *child * *frame;
  };
}

}  // namespace

LogPoses::LogPoses(std::string file, std::string topic)
    : file_(std::move(file)), topic_(std::move(topic)) {}

bool LogPoses::wants(const LogTopic& topic) const {
  if (topic.encoding != encoding_of(topic.type)) return false;
  if (is_transform_type(topic.type)) return true;
  return is_pose_type(topic.type) && (topic_.empty() || is_asked_as(topic.name, topic_));
}

void LogPoses::take(const LogTopic& topic, const LogMessage& message) {
  if (is_transform_type(topic.type)) return transforms_.take(topic, message, file_);
  const PoseMessage read = parse_pose(topic, message, file_);
  PoseTopic& poses = by_topic_[topic.name];
  poses.child = read.child.empty() ? kVehicle : read.child;
  poses.above.add({read.frame, poses.child, read.at}, topic.name, false);
}

void LogPoses::finish() {
  transforms_count_ = transforms_.finish(topic_);
  if (!topic_.empty()) keep_asked(by_topic_, topic_);
  for (auto& [name, poses] : by_topic_) {
    poses.above.sort();
    TransformTree further = transforms_.static_of(name);
    further.remove(poses.child);  // the topic says where that is
    poses.above.merge(std::move(further));
    poses.below = transforms_.below(name);
  }
}

bool LogPoses::ends_below_poses(const std::string& top) const {
  return is_of_vehicle(top) || std::ranges::any_of(by_topic_, [&](const auto& entry) {
           return entry.second.child == top;
         });
}

std::vector<LogPoses::Source> LogPoses::sources_of(const std::string& frame) const {
  std::vector<Source> found;
  for (const auto& [name, tree] : transforms_.trees()) {
    if (!transforms_count_) break;
    Way way = tree->way_up(frame, file_, kOption);
    if (!tree->leads_to_world(way) || ends_below_poses(tree->parent_of(way.back()))) continue;
    found.push_back({tree->topic_of(way), tree, along(tree, std::move(way))});
  }
  if (!found.empty()) return found;
  for (const auto& [name, poses] : by_topic_) {
    std::optional<Way> way = way_to(*poses.below, frame, poses.child, file_);
    if (!way) continue;
    Way up = poses.above.way_up(poses.child, file_, kOption);
    found.push_back(
        {name, poses.below, along(poses.above, std::move(up), poses.below, std::move(*way))});
  }
  return found;
}

PoseAt LogPoses::of(const std::string& frame) const {
  const std::vector<Source> sources = sources_of(frame);
  if (sources.empty()) return {};
  if (sources.size() == 1) return sources.front().at;
  std::vector<std::string> names;
  for (const Source& source : sources) names.push_back(source.topic);
  throw InputError({.file = file_,
                    .element = "frame " + frame,
                    .found = fmt::format("{} say where it was", fmt::join(names, ", ")),
                    .needed = "one topic",
                    .remedy = fmt::format("choose it by {}", kOption)});
}

PoseAt LogPoses::in_vehicle(const std::string& frame) const {
  const std::vector<Source> sources = sources_of(frame);
  const auto& trees = transforms_.trees();
  if (frame == kVehicle || (sources.empty() && trees.size() != 1)) return {};
  const LogTransforms::Tree tree = sources.empty() ? trees.begin()->second : sources.front().below;
  std::optional<Way> way = way_to(*tree, frame, kVehicle, file_);
  return way ? along(tree, std::move(*way)) : PoseAt();
}

}  // namespace roadbed::map::logs
