#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Groups of lanes that grow together. Four bytes a lane.
class LaneGroups {
 public:
  explicit LaneGroups(std::size_t lanes);

  /// Joins a lane with those wanted that its links or a lane change from it lead to.
  template <typename Wants>
  void join(LaneId lane, const LaneLinks& links, const Wants& wants) {
    const auto join_with = [&](LaneId other) {
      if (wants(other)) join(lane.index, other.index);
    };
    for (const LaneId successor : links.successors) join_with(successor);
    for (const LaneId predecessor : links.predecessors) join_with(predecessor);
    for (const auto* neighbour : {&links.left, &links.right}) {
      const bool leads_there =
          *neighbour && (*neighbour)->same_direction && (*neighbour)->change_allowed();
      if (leads_there) join_with((*neighbour)->lane);
    }
  }

  void join(LaneId one, LaneId other) { join(one.index, other.index); }

  /// The group's least lane, which names it.
  std::uint32_t find(std::uint32_t lane);

  /// How many of the lanes that count each group has, groups of none left out, largest first.
  std::vector<std::uint64_t> sizes(const std::vector<bool>& counts);

  /// These lanes themselves, groups of none left out: largest group first, equal ones by their
  /// first lane; lanes in order of id.
  std::vector<std::vector<LaneId>> lists(const std::vector<bool>& counts);

 private:
  void join(std::uint32_t one, std::uint32_t other);

  std::vector<std::uint32_t> parent_;
};

/// Drivable lanes in groups between which no link and no lane change leads, in either direction, as
/// LaneGroups lists them. O(lanes + links).
std::vector<std::vector<LaneId>> drivable_components(const RoadMap& road_map);

}  // namespace roadbed::map::derived
