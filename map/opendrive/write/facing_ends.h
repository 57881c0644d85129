#pragma once

#include <cstdint>
#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// Puts ends of roads into one group where lanes that both begin there, or both end, have the same
/// corners, within 5 cm, and one of them is driven both ways: it leads into the other against its
/// direction, which only their place says. O(N log N).
///
///     ──one way──▶●◀──both ways──
/// @param group  of each end, 2 · road, + 1 at its end; the least end of the group.
void unite_facing_ends(const RoadMap& road_map, const RoadPlan& plan,
                       std::vector<std::uint32_t>& group);

}  // namespace roadbed::map::opendrive
