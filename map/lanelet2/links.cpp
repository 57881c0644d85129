#include "roadbed/map/lanelet2/build_map.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

// A lane's end as seen in driving direction: its left and its right node.
using End = std::pair<std::uint32_t, std::uint32_t>;

bool share_users(const Lane& a, const Lane& b) {
  if (a.participants.empty() && b.participants.empty()) return a.type == b.type;
  return (a.participants.bits() & b.participants.bits()) != 0;
}

// More lanes do not meet anywhere on earth; the cost of a file stays in proportion to its size.
constexpr std::size_t kMostAtOnePlace = 64;

// From a key to the lanes that have it, as one sorted list.
template <typename Key>
class LanesBy {
 public:
  void add(Key key, LaneId lane) { entries_.emplace_back(key, lane); }
  void sort() { std::sort(entries_.begin(), entries_.end()); }

  // Visits at most kMostAtOnePlace lanes; false if there are more.
  template <typename Visit>
  bool visit(const Key& key, const Visit& visit_lane) const {
    auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key, LaneId{0}));
    for (std::size_t i = 0; at != entries_.end() && at->first == key; ++at, ++i) {
      if (i == kMostAtOnePlace) return false;
      visit_lane(at->second);
    }
    return true;
  }

 private:
  std::vector<std::pair<Key, LaneId>> entries_;
};

class Linker {
 public:
  Linker(const Document& document, const BuiltLanes& built)
      : document_(document), built_(built), links_(built.lanes.size()) {
    for (const Lane& lane : built.lanes) {
      const std::size_t i = lane.id.index;
      starting_at_.add({first_node(document, built.left[i]), first_node(document, built.right[i])},
                       lane.id);
      by_left_.add(built.left[i], lane.id);
      by_right_.add(built.right[i], lane.id);
    }
    starting_at_.sort();
    by_left_.sort();
    by_right_.sort();
  }

  LinkedLanes link() {
    for (const Lane& lane : built_.lanes) {
      follow(lane);
      const std::size_t i = lane.id.index;
      links_[i].left = neighbour(lane, built_.left[i], by_right_, by_left_, true);
      links_[i].right = neighbour(lane, built_.right[i], by_left_, by_right_, false);
    }
    LinkedLanes linked{std::move(links_), {}};
    if (crowded_) {
      linked.remarks.push_back({"import.crowded", true, "file", 0,
                                "more than 64 lanelets meet in one place or share a border; some "
                                "of their links are left out"});
    }
    return linked;
  }

 private:
  const Lane& lane(LaneId id) const { return built_.lanes[id.index]; }

  void follow(const Lane& from) {
    const std::size_t i = from.id.index;
    const End end{last_node(document_, built_.left[i]), last_node(document_, built_.right[i])};
    const bool all = starting_at_.visit(end, [&](LaneId to) {
      if (!share_users(from, lane(to))) return;
      links_[i].successors.push_back(to);
      links_[to.index].predecessors.push_back(from.id);
    });
    crowded_ = crowded_ || !all;
  }

  // The lane across a border: with the same direction the border is its other one, drawn the same
  // way; with the opposite direction it is the same one, drawn the other way.
  std::optional<Neighbour> neighbour(const Lane& from, const Border& border,
                                     const LanesBy<Border>& along, const LanesBy<Border>& against,
                                     bool to_left) {
    using Rank = std::tuple<bool, bool, LaneId>;
    std::optional<Rank> best;
    const auto offer = [&](LaneId candidate, bool opposite) {
      if (candidate == from.id) return;
      const Rank rank{!share_users(from, lane(candidate)), opposite, candidate};
      if (!best || rank < *best) best = rank;
    };
    const bool all = along.visit(border, [&](LaneId id) {
      offer(id, false);
    }) && against.visit({border.way, !border.reversed}, [&](LaneId id) { offer(id, true); });
    crowded_ = crowded_ || !all;
    if (!best) return {};
    const auto [strangers, opposite, id] = *best;
    Neighbour found{id, !opposite, {}};
    if (!strangers && may_cross(from, border, to_left)) {
      found.change_windows = {{0.0, from.length_m()}};
    }
    return found;
  }

  bool may_cross(const Lane& from, const Border& border, bool to_left) const {
    const CrossingRule rule = crossing_rule(document_.ways[border.way].tags, from.participants);
    return to_left != border.reversed ? rule.to_left : rule.to_right;
  }

  const Document& document_;
  const BuiltLanes& built_;
  bool crowded_ = false;
  std::vector<LaneLinks> links_;
  LanesBy<End> starting_at_;
  LanesBy<Border> by_left_, by_right_;
};

}  // namespace

LinkedLanes link_lanes(const Document& document, const BuiltLanes& built) {
  return Linker(document, built).link();
}

}  // namespace roadbed::map::lanelet2
