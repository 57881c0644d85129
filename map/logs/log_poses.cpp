#include "roadbed/map/logs/log_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {
namespace {

constexpr const char* kVehicle = "base_link";

/// With whatever namespace in front.
bool is_of_vehicle(const std::string& frame) {
  const std::string name = frame.substr(frame.rfind('/') + 1);
  return name == kVehicle || name == "base_footprint";
}

using Way = std::vector<std::string>;

/// The vehicle's own frames that a frame may be mounted on: of its namespace, then of none.
std::vector<std::string> bodies_near(const std::string& frame) {
  const std::string name_space = frame.substr(0, frame.rfind('/') + 1);
  std::vector<std::string> bodies{name_space + kVehicle};
  if (!name_space.empty()) bodies.emplace_back(kVehicle);
  return bodies;
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

PoseAt inverse(PoseAt at) {
  return [at = std::move(at)](std::int64_t stamp_ns) -> std::optional<Eigen::Isometry3d> {
    const auto pose = at(stamp_ns);
    if (!pose) return std::nullopt;
    return pose->inverse();
  };
}

/// Whether what stands there goes ahead at the same speed, however the vehicle turns.
bool is_straight_ahead(const Eigen::Isometry3d& mount) {
  constexpr double same = 1e-9;
  return mount.linear().isIdentity(same) && std::abs(mount.translation().y()) <= same;
}

/// Poses of the vehicle, which stands at `mount` in the frame of theirs.
NotedPoses moved(NotedPoses of_child, const PoseAt& mount, const std::string& child) {
  NotedPoses found{.notes = std::move(of_child.notes)};
  const std::size_t all = of_child.poses.size();
  for (const TimedPose& at : of_child.poses) {
    const auto pose = mount(at.stamp_ns);
    if (!pose) continue;
    found.poses.push_back({at.stamp_ns, at.pose * *pose});
    if (is_straight_ahead(*pose)) found.poses.back().speed_mps = at.speed_mps;
  }
  std::ranges::copy(left_out_notes(all - found.poses.size(), all,
                                   fmt::format("no transform between {} and {}", child, kVehicle)),
                    std::back_inserter(found.notes));
  return found;
}

}  // namespace

LogPoses::LogPoses(std::string file, std::string topic, std::string option)
    : file_(std::move(file)), topic_(std::move(topic)), option_(std::move(option)) {}

// From a frame up to another one; none where that is not above it.
std::optional<Way> LogPoses::way_to(const TransformTree& tree, const std::string& frame,
                                    const std::string& top) const {
  Way way = tree.way_up(frame, file_, option_, top);
  const std::string& reached = way.empty() ? frame : tree.parent_of(way.back());
  return reached == top ? std::optional(std::move(way)) : std::nullopt;
}

bool LogPoses::wants(const LogTopic& topic) const {
  if (topic.encoding != encoding_of(topic.type)) return false;
  if (is_transform_type(topic.type)) return true;
  return is_pose_type(topic.type) && (topic_.empty() || is_asked_as(topic.name, topic_));
}

void LogPoses::take(const LogTopic& topic, const LogMessage& message) {
  if (is_transform_type(topic.type)) return transforms_.take(topic, message, file_);
  const PoseMessage read = parse_pose(topic, message, file_);
  PoseTopic& poses = by_topic_[topic.name];
  const std::string child = read.child.empty() ? kVehicle : read.child;
  if (!poses.child.empty() && poses.child != child) poses.other_child = poses.child;
  poses.child = child;
  poses.above.add({read.frame, poses.child, read.at}, topic.name, false);
}

void LogPoses::finish() {
  transforms_count_ = transforms_.finish(topic_);
  if (!topic_.empty()) keep_asked(by_topic_, topic_);
  for (auto& [name, poses] : by_topic_) {
    poses.above.sort();
    poses.below = transforms_.below(name);
    poses.above.go_on_in(poses.below, poses.child);  // the topic says where that is
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
    Way way = tree->way_up(frame, file_, option_);
    if (!tree->leads_to_world(way) || ends_below_poses(tree->parent_of(way.back()))) continue;
    found.push_back({tree->topic_of(way), tree, along(tree, std::move(way))});
  }
  if (!found.empty()) return found;
  for (const auto& [name, poses] : by_topic_) {
    std::optional<Way> way = way_to(*poses.below, frame, poses.child);
    if (!way) continue;
    Way up = poses.above.way_up(poses.child, file_, option_);
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
                    .remedy = fmt::format("choose it by {}", option_)});
}

PoseAt LogPoses::in_vehicle(const std::string& frame) const {
  const std::vector<Source> sources = sources_of(frame);
  const auto& trees = transforms_.trees();
  if (frame == kVehicle || (sources.empty() && trees.size() != 1)) return {};
  const LogTransforms::Tree tree = sources.empty() ? trees.begin()->second : sources.front().below;
  std::optional<Way> way = way_to(*tree, frame, kVehicle);
  return way ? along(tree, std::move(*way)) : PoseAt();
}

std::vector<std::string> LogPoses::pose_topics() const {
  std::vector<std::string> names;
  for (const auto& [name, poses] : by_topic_) names.push_back(name);
  return names;
}

PoseAt LogPoses::body_in_child(const PoseTopic& poses) const {
  for (const std::string& body : bodies_near(poses.child)) {
    if (body == poses.child) return {};
    if (auto way = way_to(*poses.below, poses.child, body)) {
      return inverse(along(poses.below, std::move(*way)));
    }
    if (auto way = way_to(*poses.below, body, poses.child)) {
      return along(poses.below, std::move(*way));
    }
  }
  return {};
}

NotedPoses LogPoses::drive_by(const std::string& topic, DriveFrame frame) const {
  const PoseTopic& by = by_topic_.at(topic);
  if (!by.other_child.empty()) {
    throw InputError({.file = file_,
                      .element = topic,
                      .found = "is of the frames " + by.other_child + " and " + by.child,
                      .needed = "one",
                      .remedy = "record it anew"});
  }
  NotedPoses of_child = by.above.poses(by.above.way_up(by.child, file_, option_));
  if (frame == DriveFrame::recorded) return of_child;
  if (const PoseAt mount = body_in_child(by)) return moved(std::move(of_child), mount, by.child);
  if (!is_of_vehicle(by.child)) {
    of_child.notes.push_back(
        fmt::format("{} is of {}, taken for the rear axle, as no transform says where it is in {}; "
                    "--pose-frame says it",
                    topic, by.child, kVehicle));
  }
  return of_child;
}

}  // namespace roadbed::map::logs
