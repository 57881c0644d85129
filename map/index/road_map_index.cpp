#include "roadbed/map/index/road_map_index.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace roadbed::map::inline index {

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

void RoadMapIndexCheck::add(const Lane& lane) {
  lanes_->add(lane);
  names_ += lane.name;
  name_at_.push_back(names_.size());
}

std::string_view RoadMapIndexCheck::name(std::uint32_t lane) const {
  return std::string_view(names_).substr(name_at_[lane], name_at_[lane + 1] - name_at_[lane]);
}

// As many as there are lanes, each after the one before: then every lane is there once.
bool RoadMapIndexCheck::are_names_in_order() const {
  const FlatArray<std::uint32_t>& by_name = index_.by_name;
  const std::size_t lanes = name_at_.size() - 1;
  if (by_name.size() != lanes) return false;
  for (std::size_t i = 0; i < lanes; ++i) {
    const std::uint32_t id = by_name[i];
    if (id >= lanes) return false;
    if (i == 0) continue;
    const std::uint32_t before = by_name[i - 1];
    if (std::tuple(name(before), before) >= std::tuple(name(id), id)) return false;
  }
  return true;
}

bool RoadMapIndexCheck::holds() { return lanes_->holds() && are_names_in_order(); }

}  // namespace roadbed::map::index
