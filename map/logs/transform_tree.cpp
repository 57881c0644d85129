#include "roadbed/map/logs/transform_tree.h"

#include <algorithm>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {

void TransformTree::add(const FrameTransform& transform, bool is_static, const std::string& file) {
  Edge& edge = edges_[transform.child];
  if (!edge.parent.empty() && edge.parent != transform.parent) {
    throw InputError({.file = file,
                      .element = "frame " + transform.child,
                      .found = "stands in " + edge.parent + " and in " + transform.parent,
                      .needed = "one parent",
                      .remedy = "name a topic of poses by --topic"});
  }
  edge.parent = transform.parent;
  edge.is_static = is_static;
  if (is_static) edge.poses.clear();  // the last one holds
  edge.poses.push_back(transform.child_in_parent);
}

void TransformTree::sort() {
  for (auto& [child, edge] : edges_) sort_by_stamp(edge.poses);
}

std::vector<std::string> TransformTree::way_up(const std::string& child,
                                               const std::string& file) const {
  std::vector<std::string> way;
  std::string frame = child;
  for (auto edge = edges_.find(frame); frame != "map" && edge != edges_.end();
       edge = edges_.find(frame)) {
    way.push_back(frame);
    if (way.size() > edges_.size()) {
      throw InputError({.file = file,
                        .element = "frame " + child,
                        .found = "stands in itself",
                        .needed = "frames without a circle",
                        .remedy = "name a topic of poses by --topic"});
    }
    frame = edge->second.parent;
  }
  return way;
}

std::optional<Eigen::Isometry3d> TransformTree::at(const std::vector<std::string>& way,
                                                   std::int64_t stamp_ns) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const std::string& child : way) {
    const Edge& edge = edges_.at(child);
    const auto step = edge.is_static ? edge.poses.front().pose : pose_at(edge.poses, stamp_ns);
    if (!step) return std::nullopt;
    pose = *step * pose;
  }
  return pose;
}

std::vector<TimedPose> TransformTree::poses(const std::vector<std::string>& way) const {
  std::vector<TimedPose> found;
  const auto moving =
      std::ranges::find_if(way, [&](const auto& child) { return !edges_.at(child).is_static; });
  if (moving == way.end()) return found;
  for (const TimedPose& at_stamp : edges_.at(*moving).poses) {
    if (const auto pose = at(way, at_stamp.stamp_ns)) found.push_back({at_stamp.stamp_ns, *pose});
  }
  return found;
}

bool TransformTree::leads_to_world(const std::vector<std::string>& way) const {
  if (way.empty()) return false;
  return edges_.at(way.back()).parent == "map" ||
         std::ranges::any_of(way, [&](const auto& child) { return !edges_.at(child).is_static; });
}

void TransformTree::add_static_of(const TransformTree& other) {
  for (const auto& [child, edge] : other.edges_) {
    if (edge.is_static) edges_.try_emplace(child, edge);
  }
}

std::vector<std::string> TransformTree::children() const {
  std::vector<std::string> names;
  for (const auto& [child, edge] : edges_) names.push_back(child);
  return names;
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
