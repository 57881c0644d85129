#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/sumo/directed_lanes.h"

namespace roadbed::map::sumo {

/// Of each lane the number of the junction that it is inside, so that it is a connection there and
/// no edge; none: it is outside. A lane is inside a crossing that the map names
/// (derived/crossings.h); a short lane that crosses one of those, or any other short one where it
/// names none. What leads from nowhere to nowhere is an edge all the same. Numbers less than
/// `junctions().size()` are indices of the map's junctions.
std::vector<std::optional<std::uint32_t>> find_inner_lanes(const RoadMap& road_map,
                                                           const DirectedLanes& ways,
                                                           const std::vector<Conflict>& conflicts);

}  // namespace roadbed::map::sumo
