#include "roadbed/map/logs/log_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {
namespace {

constexpr const char* kVehicle = "base_link";

bool is_static(const LogTopic& topic) { return topic.name.ends_with("tf_static"); }

PoseAt along(const TransformTree& tree, std::vector<std::string> way) {
  return [&tree, way = std::move(way)](std::int64_t stamp_ns) { return tree.at(way, stamp_ns); };
}

}  // namespace

LogPoses::LogPoses(std::string file, std::string topic)
    : file_(std::move(file)), topic_(std::move(topic)) {}

bool LogPoses::wants(const LogTopic& topic) const {
  if (topic.encoding != encoding_of(topic.type)) return false;
  if (is_transform_type(topic.type) && is_static(topic)) return true;
  if (!is_transform_type(topic.type) && !is_pose_type(topic.type)) return false;
  return topic_.empty() || topic_ == topic.name;
}

void LogPoses::take(const LogTopic& topic, const LogMessage& message) {
  if (is_transform_type(topic.type)) {
    for (const FrameTransform& transform : parse_transforms(topic, message, file_)) {
      transforms_.add(transform, is_static(topic), file_);
    }
    return;
  }
  const PoseMessage read = parse_pose(topic, message, file_);
  by_topic_[topic.name].add({read.frame, read.child.empty() ? kVehicle : read.child, read.at},
                            false, file_);
}

void LogPoses::finish() {
  transforms_.sort();
  for (auto& [name, tree] : by_topic_) {
    tree.sort();
    tree.add_static_of(transforms_);
  }
}

PoseAt LogPoses::of(const std::string& frame) const {
  std::vector<std::string> way = transforms_.way_up(frame, file_);
  if (transforms_.leads_to_world(way)) return along(transforms_, std::move(way));
  PoseAt found;
  std::vector<std::string> names;
  for (const auto& [name, tree] : by_topic_) {
    way = tree.way_up(frame, file_);
    if (!tree.leads_to_world(way)) continue;
    names.push_back(name);
    found = along(tree, std::move(way));
  }
  if (names.size() < 2) return found;
  throw InputError({.file = file_,
                    .element = "frame " + frame,
                    .found = fmt::format("{} say where it was", fmt::join(names, ", ")),
                    .needed = "one topic",
                    .remedy = "choose it by --pose-topic"});
}

PoseAt LogPoses::in_vehicle(const std::string& frame) const {
  std::vector<std::string> way = transforms_.way_up(frame, file_);
  const auto vehicle = std::ranges::find(way, kVehicle);
  if (vehicle == way.begin()) return {};  // it is that frame itself
  if (vehicle == way.end() && (way.empty() || transforms_.parent_of(way.back()) != kVehicle)) {
    return {};
  }
  way.erase(vehicle, way.end());
  return along(transforms_, std::move(way));
}

}  // namespace roadbed::map::logs
