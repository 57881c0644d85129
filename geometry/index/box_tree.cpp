#include "roadbed/geometry/index/box_tree.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <utility>

#include "roadbed/geometry/index/hilbert.h"

namespace roadbed::geometry::inline index {
namespace {

constexpr std::size_t kChildren = 8;

Box parent_box(const std::vector<Box>& children, std::size_t parent) {
  Box box;
  const std::size_t end = std::min(children.size(), (parent + 1) * kChildren);
  for (std::size_t i = parent * kChildren; i < end; ++i) box.extend(children[i]);
  return box;
}

std::vector<std::uint32_t> hilbert_order(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  std::vector<std::uint32_t> key;
  key.reserve(boxes.size());
  for (const Box& box : boxes) key.push_back(hilbert_key(all, box.center()));
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(key[a], a) < std::pair(key[b], b);
  });
  return order;
}

/// A node or box still to look at, the nearest first.
struct Open {
  double distance_m;
  std::size_t level, index;
  bool operator<(const Open& other) const { return distance_m > other.distance_m; }
};

}  // namespace

Box box_around(std::span<const Eigen::Vector2d> points) {
  Box box;
  for (const Eigen::Vector2d& point : points) box.extend(point);
  return box;
}

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(hilbert_order(boxes)) {
  if (boxes.empty()) return;
  levels_.emplace_back();
  levels_.back().reserve(boxes.size());
  for (const std::uint32_t index : order_) levels_.back().push_back(boxes[index]);
  while (levels_.back().size() > kChildren) {
    const std::vector<Box>& children = levels_.back();
    std::vector<Box> parents((children.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = parent_box(children, i);
    levels_.push_back(std::move(parents));
  }
}

void BoxTree::visit(const Box& box, const std::function<void(std::size_t)>& found) const {
  if (levels_.empty()) return;
  std::vector<std::pair<std::size_t, std::size_t>> open;  // level, index
  for (std::size_t i = levels_.back().size(); i-- > 0;) open.emplace_back(levels_.size() - 1, i);
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
  add(levels_.size() - 1, 0, levels_.back().size());
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
