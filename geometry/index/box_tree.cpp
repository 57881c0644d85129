#include "roadbed/geometry/index/box_tree.h"

#include <algorithm>
#include <queue>
#include <utility>

#include "roadbed/geometry/index/hilbert.h"

namespace roadbed::geometry::inline index {
namespace {

constexpr std::size_t kChildren = 8;

std::vector<Box> parents_of(const std::vector<Box>& children, std::size_t width) {
  std::vector<Box> parents((children.size() + width - 1) / width);
  for (std::size_t i = 0; i < children.size(); ++i) parents[i / width].extend(children[i]);
  return parents;
}

std::vector<std::uint32_t> hilbert_order(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  std::vector<std::uint32_t> key;
  key.reserve(boxes.size());
  for (const Box& box : boxes) key.push_back(hilbert_key(all, box.center()));
  return order_of_keys(key);
}

/// A node or box still to look at, the nearest first.
struct Open {
  double distance_m;
  std::size_t level, index;
  // Nearer ones first; where many hold the point, those that are asked themselves.
  bool operator<(const Open& other) const {
    return distance_m != other.distance_m ? distance_m > other.distance_m : level > other.level;
  }
};

}  // namespace

Box box_around(std::span<const Eigen::Vector2d> points) {
  Box box;
  for (const Eigen::Vector2d& point : points) box.extend(point);
  return box;
}

std::vector<std::vector<Box>> packed_levels(std::vector<Box> leaves, std::size_t width) {
  std::vector<std::vector<Box>> levels{std::move(leaves)};
  do levels.push_back(parents_of(levels.back(), width));
  while (levels.back().size() > 1);
  return levels;
}

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(hilbert_order(boxes)) {
  if (boxes.empty()) return;
  std::vector<Box> leaves;
  leaves.reserve(boxes.size());
  for (const std::uint32_t index : order_) leaves.push_back(boxes[index]);
  levels_ = packed_levels(std::move(leaves), kChildren);
}

void BoxTree::visit(const Box& box, const std::function<void(std::size_t)>& found) const {
  if (levels_.empty()) return;
  std::vector<std::pair<std::size_t, std::size_t>> open;  // level, index
  open.emplace_back(levels_.size() - 1, 0);
  while (!open.empty()) {
    const auto [level, index] = open.back();
    open.pop_back();
    if (!levels_[level][index].intersects(box)) continue;
    if (level == 0) {
      found(order_[index]);
      continue;
    }
    const std::size_t end = std::min(levels_[level - 1].size(), (index + 1) * kChildren);
    for (std::size_t i = end; i-- > index * kChildren;) open.emplace_back(level - 1, i);
  }
}

std::size_t BoxTree::nearest(const Eigen::Vector2d& point, double most_m,
                             const std::function<double(std::size_t)>& distance_m) const {
  std::size_t best = order_.size();
  if (levels_.empty()) return best;
  std::priority_queue<Open> open;
  const auto add = [&](std::size_t level, std::size_t from, std::size_t end) {
    for (std::size_t i = from; i < end; ++i) {
      const double lower_m = levels_[level][i].exteriorDistance(point);
      if (lower_m < most_m) open.push({lower_m, level, i});
    }
  };
  add(levels_.size() - 1, 0, 1);
  while (!open.empty() && open.top().distance_m < most_m) {
    const Open next = open.top();
    open.pop();
    if (next.level > 0) {
      const std::size_t first = next.index * kChildren;
      add(next.level - 1, first, std::min(levels_[next.level - 1].size(), first + kChildren));
      continue;
    }
    const double found_m = distance_m(order_[next.index]);
    if (found_m >= most_m) continue;
    most_m = found_m;
    best = order_[next.index];
  }
  return best;
}

}  // namespace roadbed::geometry::index
