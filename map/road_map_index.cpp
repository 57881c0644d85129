#include "roadbed/map/road_map_index.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace roadbed::map {

RoadMapIndex RoadMapIndex::of(const LazyList<Lane>& lanes) {
  std::vector<std::uint32_t> by_name(lanes.size());
  std::iota(by_name.begin(), by_name.end(), 0U);
  std::sort(by_name.begin(), by_name.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(lanes[a].name, a) < std::tie(lanes[b].name, b);
  });
  return {LaneIndex(lanes), FlatArray<std::uint32_t>(std::move(by_name))};
}

std::optional<LaneId> RoadMapIndex::find(const LazyList<Lane>& in, std::string_view name) const {
  const auto lane_at = [&](std::uint64_t place) -> const Lane& {
    const std::uint32_t id = by_name[place];
    if (id >= in.size()) by_name.refuse("a lane that is not there");
    return in[id];
  };
  std::uint64_t first = 0, end = by_name.size();
  while (first < end) {
    const std::uint64_t middle = first + (end - first) / 2;
    if (lane_at(middle).name < name) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  if (first == by_name.size() || lane_at(first).name != name) return {};
  return LaneId{by_name[first]};
}

void RoadMapIndex::check(const LazyList<Lane>& against) const {
  const RoadMapIndex right = of(against);
  bool same = by_name.bytes() == right.by_name.bytes();
  const auto compare = [&same](const char*, const auto& mine, const auto& its) {
    same = same && mine.bytes() == its.bytes();
  };
  lane_index::visit(compare, lanes.data(), right.lanes.data());
  if (!same) throw std::invalid_argument("the index does not belong to these lanes");
}

}  // namespace roadbed::map
