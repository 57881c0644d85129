#pragma once

#include <compare>
#include <cstdint>

namespace roadbed::map::inline elements {

/// Names one thing of one map: its place in the map's list of such things. Ids of different kinds
/// cannot be interchanged: `Id<struct LaneTag>` is not `Id<struct RoadTag>`.
template <typename Tag>
struct Id {
  std::uint32_t index = 0;
  auto operator<=>(const Id&) const = default;
};

using LaneId = Id<struct LaneTag>;
using RoadId = Id<struct RoadTag>;
using JunctionId = Id<struct JunctionTag>;

}  // namespace roadbed::map::elements
