#include "roadbed/map/components.h"

#include <algorithm>
#include <numeric>

namespace roadbed::map {
namespace {

/// Groups that grow together; a group is named by its least member.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::uint32_t find(std::uint32_t member) {
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

  void join(std::uint32_t one, std::uint32_t other) {
    const std::uint32_t a = find(one), b = find(other);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void join_with_linked(const RoadMap& road_map, LaneId lane, Groups& groups) {
  const auto join = [&](LaneId other) {
    if (is_drivable(road_map.lane(other).type)) groups.join(lane.index, other.index);
  };
  const LaneLinks& links = road_map.graph().of(lane);
  for (const LaneId successor : links.successors) join(successor);
  for (const LaneId predecessor : links.predecessors) join(predecessor);
  for (const auto& neighbour : {links.left, links.right}) {
    if (neighbour && neighbour->same_direction && neighbour->change_allowed())
      join(neighbour->lane);
  }
}

}  // namespace

std::vector<std::vector<LaneId>> drivable_components(const RoadMap& road_map) {
  Groups groups(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) join_with_linked(road_map, lane.id, groups);
  }
  std::vector<std::vector<LaneId>> by_least(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) by_least[groups.find(lane.id.index)].push_back(lane.id);
  }
  std::erase_if(by_least, [](const auto& group) { return group.empty(); });
  std::stable_sort(by_least.begin(), by_least.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return by_least;
}

}  // namespace roadbed::map
