#include "roadbed/map/derived/components.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace roadbed::map::inline derived {
LaneGroups::LaneGroups(std::size_t lanes) : parent_(lanes) {
  std::iota(parent_.begin(), parent_.end(), 0U);
}

std::uint32_t LaneGroups::find(std::uint32_t lane) {
  while (parent_[lane] != lane) {
    parent_[lane] = parent_[parent_[lane]];
    lane = parent_[lane];
  }
  return lane;
}

void LaneGroups::join(std::uint32_t one, std::uint32_t other) {
  const std::uint32_t a = find(one), b = find(other);
  parent_[std::max(a, b)] = std::min(a, b);
}

std::vector<std::uint64_t> LaneGroups::sizes(const std::vector<bool>& counts) {
  std::vector<std::uint64_t> sizes(parent_.size(), 0);
  for (std::uint32_t lane = 0; lane < parent_.size(); ++lane) {
    if (counts[lane]) ++sizes[find(lane)];
  }
  std::erase(sizes, 0U);
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

std::vector<std::vector<LaneId>> LaneGroups::lists(const std::vector<bool>& counts) {
  std::vector<std::vector<LaneId>> by_least(parent_.size());
  for (std::uint32_t lane = 0; lane < parent_.size(); ++lane) {
    if (counts[lane]) by_least[find(lane)].push_back(LaneId{lane});
  }
  std::erase_if(by_least, [](const auto& group) { return group.empty(); });
  std::stable_sort(by_least.begin(), by_least.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return by_least;
}

std::vector<std::vector<LaneId>> drivable_components(const RoadMap& road_map) {
  LaneGroups groups(road_map.lanes().size());
  std::vector<bool> counts;
  for (const Lane& lane : road_map.lanes()) counts.push_back(is_drivable(lane.type));
  const auto wants = [&](LaneId id) { return counts[id.index]; };
  for (const Lane& lane : road_map.lanes()) {
    if (wants(lane.id)) groups.join(lane.id, road_map.graph().of(lane.id), wants);
  }
  return groups.lists(counts);
}

}  // namespace roadbed::map::derived
