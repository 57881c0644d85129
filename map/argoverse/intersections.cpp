#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/argoverse/lane_segments.h"

namespace roadbed::map::argoverse {
namespace {

constexpr double kStep_m = 1.0, kCell_m = 2.0;

/// Joins all lanes that give the same key.
class ByKey {
 public:
  explicit ByKey(geometry::DisjointSets& groups) : groups_(groups) {}

  void add(std::int64_t key, std::size_t lane) {
    groups_.join(first_.emplace(key, lane).first->second, lane);
  }

 private:
  geometry::DisjointSets& groups_;
  std::unordered_map<std::int64_t, std::size_t> first_;
};

/// Each cell of a grid that the line goes through, at steps of half a cell.
template <typename Visit>
void visit_cells(const geometry::Polyline& line, geometry::WorkBudget& budget, const Visit& visit) {
  for (double s_m = 0.0; s_m <= line.length_m() && budget.spend(1); s_m += kStep_m) {
    const Eigen::Vector2d cell = line.at(s_m) / kCell_m;
    const auto x = static_cast<std::int64_t>(std::floor(cell.x()));
    const auto y = static_cast<std::int64_t>(std::floor(cell.y()));
    visit(x * (std::int64_t{1} << 32) + y);
  }
}

}  // namespace

std::vector<Junction> LaneSegments::group_intersections() {
  geometry::DisjointSets groups(lanes_.size());
  ByKey leading_to(groups), coming_from(groups), passing(groups);
  geometry::WorkBudget budget(geometry::most_steps(lanes_.size()));
  const auto join_inside = [&](std::size_t lane, std::int64_t id) {
    const auto other = find(id);
    if (other && is_intersection_[other->index]) groups.join(lane, other->index);
  };
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (!is_intersection_[i]) continue;
    for (const std::int64_t id : named_[i].successors) {
      leading_to.add(id, i);
      join_inside(i, id);
    }
    for (const std::int64_t id : named_[i].predecessors) coming_from.add(id, i);
    for (const auto& id : {named_[i].left, named_[i].right}) {
      if (id) join_inside(i, *id);
    }
    visit_cells(lanes_[i].centre.in_map, budget, [&](std::int64_t cell) { passing.add(cell, i); });
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (const std::int64_t id : named_[i].successors) {
      const auto to = find(id);
      if (to && is_intersection_[to->index]) coming_from.add(ids_[i], to->index);
    }
  }
  std::vector<Junction> junctions;
  std::map<std::size_t, std::pair<JunctionId, std::int64_t>> junction_of_group;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (!is_intersection_[i]) continue;
    const JunctionId next{static_cast<std::uint32_t>(junctions.size())};
    const auto [found, is_new] = junction_of_group.try_emplace(groups.of(i), next, ids_[i]);
    if (is_new) junctions.emplace_back().id = next;
    auto& [id, least] = found->second;
    least = std::min(least, ids_[i]);
    junctions[id.index].source_id = std::to_string(least);
    lanes_[i].junction = id;
  }
  return junctions;
}

}  // namespace roadbed::map::argoverse
