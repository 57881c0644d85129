#include "roadbed/map/logs/transform_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::size_t kMostFrames = 256;  // on a way up, which is gone for each message

std::vector<LogGap> gaps_of(const std::vector<TimedPose>& poses) {
  std::vector<std::int64_t> times_ns;
  for (const TimedPose& pose : poses) times_ns.push_back(pose.stamp_ns);
  std::int64_t median_ns = 0;
  std::vector<LogGap> gaps = gaps_in(times_ns, median_ns);
  // At 10 m/s² a straight line over it is off by 8 cm: irregular stamps do no harm.
  constexpr std::int64_t bridged_ns = 250'000'000;
  std::erase_if(gaps, [](const LogGap& gap) { return gap.to_ns - gap.from_ns <= bridged_ns; });
  return gaps;
}

}  // namespace

void TransformTree::add(const FrameTransform& transform, const std::string& topic, bool is_static) {
  Edge& edge = edges_[transform.child];
  if (edge.parent.empty()) edge.parent = transform.parent;
  if (edge.parent != transform.parent) edge.other_parent = transform.parent;
  edge.topic = topic;
  edge.is_static = is_static;
  if (is_static) edge.poses.clear();  // the last one holds
  edge.poses.push_back(transform.child_in_parent);
}

void TransformTree::sort() {
  for (auto& [child, edge] : edges_) {
    sort_by_stamp(edge.poses);
    edge.gaps = gaps_of(edge.poses);
  }
}

void TransformTree::hold_what_was_said_once() {
  for (auto& [child, edge] : edges_) edge.is_held = !edge.is_static && edge.poses.size() == 1;
}

void TransformTree::merge(TransformTree other) {
  edges_.merge(other.edges_);
  for (const auto& [child, edge] : other.edges_) {  // which stay there: this has them
    Edge& own = edges_.at(child);
    if (own.parent != edge.parent) own.other_parent = edge.parent;
  }
}

void TransformTree::go_on_in(std::shared_ptr<const TransformTree> further, const std::string& but) {
  for (auto& [child, own] : edges_) {
    const Edge* other = child == but ? nullptr : further->find(child);
    if (other != nullptr && other->parent != own.parent) own.other_parent = other->parent;
  }
  further_ = std::move(further);
  not_further_ = but;
}

const TransformTree::Edge* TransformTree::find(const std::string& child) const {
  const auto found = edges_.find(child);
  if (found != edges_.end()) return &found->second;
  return further_ && child != not_further_ ? further_->find(child) : nullptr;
}

std::vector<std::string> TransformTree::way_up(const std::string& child, const std::string& file,
                                               const std::string& option,
                                               const std::string& top) const {
  const auto refuse = [&](const std::string& frame, const std::string& found,
                          const std::string& needed) {
    throw InputError({.file = file,
                      .element = "frame " + frame,
                      .found = found,
                      .needed = needed,
                      .remedy = "name a topic of poses by " + option});
  };
  std::vector<std::string> way;
  std::string frame = child;
  for (const Edge* edge = find(frame); frame != top && frame != "map" && edge != nullptr;
       edge = find(frame)) {
    way.push_back(frame);
    if (way.size() > size()) refuse(child, "stands in itself", "frames without a circle");
    if (way.size() > kMostFrames) {
      refuse(child, fmt::format("stands in more than {} frames", kMostFrames), "a shorter chain");
    }
    const auto& [parent, other] = std::tie(edge->parent, edge->other_parent);
    if (!other.empty()) refuse(frame, "stands in " + parent + " and in " + other, "one parent");
    frame = parent;
  }
  return way;
}

std::optional<Eigen::Isometry3d> TransformTree::Edge::at(std::int64_t stamp_ns) const {
  if (is_static || is_held) return poses.front().pose;
  const auto next = std::ranges::lower_bound(gaps, stamp_ns, {}, &LogGap::to_ns);
  const bool is_in_gap = next != gaps.end() && next->from_ns < stamp_ns && stamp_ns < next->to_ns;
  return is_in_gap ? std::nullopt : pose_at(poses, stamp_ns);
}

std::optional<Eigen::Isometry3d> TransformTree::at(const std::vector<std::string>& way,
                                                   std::int64_t stamp_ns) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const std::string& child : way) {
    const auto step = edge_of(child).at(stamp_ns);
    if (!step) return std::nullopt;
    pose = *step * pose;
  }
  return pose;
}

std::vector<std::string>::const_iterator TransformTree::lowest_moving(
    const std::vector<std::string>& way) const {
  const auto moves = [&](const std::string& child) {
    const Edge& one = edge_of(child);
    return !one.is_static && !one.is_held;
  };
  const auto moving = std::ranges::find_if(way, moves);
  if (moving != way.end()) return moving;
  return std::ranges::find_if(way, [&](const auto& child) { return !edge_of(child).is_static; });
}

NotedPoses TransformTree::poses(const std::vector<std::string>& way) const {
  NotedPoses found;
  const auto moving = lowest_moving(way);
  if (moving == way.end()) return found;
  const std::vector<TimedPose>& all = edge_of(*moving).poses;
  for (const TimedPose& at_stamp : all) {
    if (const auto pose = at(way, at_stamp.stamp_ns)) {
      found.poses.push_back({at_stamp.stamp_ns, *pose, at_stamp.speed_mps});
    }
  }
  found.notes = left_out_notes(all.size() - found.poses.size(), all.size(),
                               "no transform from " + parent_of(way.back()));
  return found;
}

bool TransformTree::leads_to_world(const std::vector<std::string>& way) const {
  if (way.empty()) return false;
  return edge_of(way.back()).parent == "map" || lowest_moving(way) != way.end();
}

const std::string& TransformTree::topic_of(const std::vector<std::string>& way) const {
  const auto moving = lowest_moving(way);
  return edge_of(moving == way.end() ? way.front() : *moving).topic;
}

std::vector<std::string> TransformTree::children() const {
  std::vector<std::string> names;
  for (const auto& [child, edge] : edges_) names.push_back(child);
  return names;
}

std::vector<std::string> left_out_notes(std::size_t left_out, std::size_t all,
                                        const std::string& what_is_missing) {
  if (left_out == 0) return {};
  return {fmt::format("{} of {} poses left out: {} at their time", left_out, all, what_is_missing)};
}

std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses,
                                         std::int64_t stamp_ns) {
  const auto after = std::ranges::lower_bound(poses, stamp_ns, {}, &TimedPose::stamp_ns);
  if (after == poses.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->pose;
  if (after == poses.begin()) return std::nullopt;
  const TimedPose& before = *(after - 1);
  const double fraction = static_cast<double>(stamp_ns - before.stamp_ns) /
                          static_cast<double>(after->stamp_ns - before.stamp_ns);
  const Eigen::Quaterniond from(before.pose.linear()), to(after->pose.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = from.slerp(fraction, to).toRotationMatrix();
  pose.translation() = before.pose.translation() +
                       fraction * (after->pose.translation() - before.pose.translation());
  return pose;
}

void sort_by_stamp(std::vector<TimedPose>& poses) {
  std::ranges::stable_sort(poses, {}, &TimedPose::stamp_ns);
  const auto is_at_one_time = [](const TimedPose& a, const TimedPose& b) {
    return a.stamp_ns == b.stamp_ns;
  };
  poses.erase(std::unique(poses.begin(), poses.end(), is_at_one_time), poses.end());
}

}  // namespace roadbed::map::logs
