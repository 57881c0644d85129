#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Of each lane the number of the crossing that the map says it is inside; none: it is outside, or
/// the map does not say. The crossing is the junction whose connecting road holds the lane, and
/// then its index; else an intersection to whose incoming lanes the lane is a successor
/// (CommonRoad); else all lanes that turn, as Lanelet2 says it, and lie over each other.
/// @param counts  by LaneId: whether a lane that only turns is looked at.
/// @throws InputError where far too many lanes that turn lie over each other.
std::vector<std::optional<std::uint32_t>> crossings_of_lanes(const RoadMap& road_map,
                                                             const std::vector<bool>& counts);

/// Whether the lane is a crosswalk, which is no road but an object or a part of a junction
/// elsewhere.
bool is_crosswalk(const Lane& lane);

}  // namespace roadbed::map::derived
