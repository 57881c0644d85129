#include "roadbed/map/opendrive/write/facing_ends.h"

#include <algorithm>

#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kCorner_m = 0.05;

/// Where the borders of a lane end.
struct Gate {
  Eigen::Vector2d left, right;
  std::uint32_t end = 0;
  bool is_exit = false, one_way = true;

  bool faces(const Gate& other) const {
    return is_exit == other.is_exit && !(one_way && other.one_way) &&
           (left - other.right).norm() <= kCorner_m && (right - other.left).norm() <= kCorner_m;
  }
};

std::vector<Gate> gates_by_left_x(const RoadMap& road_map, const RoadPlan& plan) {
  std::vector<Gate> gates;
  for (const Lane& lane : road_map.lanes()) {
    const auto &left = lane.left.in_map.points(), &right = lane.right.in_map.points();
    if (const auto end = entry_end(plan, lane.id)) {
      gates.push_back({left.front(), right.front(), *end, false, lane.one_way});
    }
    if (const auto end = exit_end(plan, lane.id)) {
      gates.push_back({left.back(), right.back(), *end, true, lane.one_way});
    }
  }
  std::ranges::stable_sort(gates, {}, [](const Gate& gate) { return gate.left.x(); });
  return gates;
}

}  // namespace

void unite_facing_ends(const RoadMap& road_map, const RoadPlan& plan,
                       std::vector<std::uint32_t>& group) {
  geometry::DisjointSets sets(group.size());
  for (std::uint32_t end = 0; end < group.size(); ++end) sets.join(end, group[end]);
  const std::vector<Gate> gates = gates_by_left_x(road_map, plan);
  for (const Gate& gate : gates) {
    if (gate.one_way) continue;
    const double from_m = gate.right.x() - kCorner_m, to_m = gate.right.x() + kCorner_m;
    for (auto other = std::ranges::lower_bound(gates, from_m, {},
                                               [](const Gate& one) { return one.left.x(); });
         other != gates.end() && other->left.x() <= to_m; ++other) {
      if (gate.faces(*other)) sets.join(gate.end, other->end);
    }
  }
  for (std::uint32_t end = 0; end < group.size(); ++end) {
    group[end] = static_cast<std::uint32_t>(sets.of(end));
  }
}

}  // namespace roadbed::map::opendrive
