#pragma once

#include <set>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline audit {

/// Leaves out lanes above and below the road that a drive is on: those that at each place of the
/// drive from which they are at most `within_m` away are over 2 m higher or lower than it, and 0.15
/// m more for each metre away. The drive begins on the lane along it under its first pose, and
/// stays on the lane whose height is next to the last one; where there is none within 2 m it stays
/// as high as it was: who leaves a bridge over its edge is not on the road below. Of several levels
/// at the beginning it is on that on which it has lanes under it for the most of its way.
///
/// Lanes without heights stay. `map::road_under` asks for more: it refuses steps between lanes, and
/// places where it is not clear on which of several a drive begins. O(poses × lanes near), nothing
/// where all lanes are of one level.
/// @param map_from_vehicle  of the drive, at most 3 m apart.
std::set<map::LaneId> lanes_on_level(const map::RoadMap& road_map, std::set<map::LaneId> lanes,
                                     const std::vector<geometry::Pose2>& map_from_vehicle,
                                     double within_m);

}  // namespace roadbed::planning::audit
