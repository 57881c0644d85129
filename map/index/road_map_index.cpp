#include "roadbed/map/index/road_map_index.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "roadbed/map/files/in_threads.h"

namespace roadbed::map::inline index {
namespace {

/// A lane with how its name begins, which most names are told apart by, without the lane.
struct NamedLane {
  std::array<unsigned char, 16> head{};
  std::uint32_t lane = 0;
};

std::vector<std::uint32_t> in_order_of_name(const LazyList<Lane>& lanes) {
  std::vector<NamedLane> named(lanes.size());
  for (std::uint32_t i = 0; i < named.size(); ++i) {
    const std::string& name = lanes[i].name;
    std::copy_n(name.begin(), std::min(name.size(), named[i].head.size()), named[i].head.begin());
    named[i].lane = i;
  }
  std::ranges::sort(named, [&](const NamedLane& a, const NamedLane& b) {
    if (a.head != b.head) return a.head < b.head;
    return std::tie(lanes[a.lane].name, a.lane) < std::tie(lanes[b.lane].name, b.lane);
  });
  std::vector<std::uint32_t> order;
  order.reserve(named.size());
  for (const NamedLane& one : named) order.push_back(one.lane);
  return order;
}

}  // namespace

RoadMapIndex RoadMapIndex::of(const LazyList<Lane>& lanes, int threads) {
  RoadMapIndex index;
  in_threads(2, threads, [&](std::size_t task) {
    if (task == 0) index.lanes = LaneIndex(lanes);
    if (task == 1) index.by_name = FlatArray<std::uint32_t>(in_order_of_name(lanes));
  });
  return index;
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
