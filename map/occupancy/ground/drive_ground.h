#pragma once

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline ground {

/// The road's surface under a drive, from the lanes of a map with their heights, at places up to a
/// metre apart. Where roads lie above one another the drive stays on the one that it is on.
/// @throws InputError if a place is over 20 m from every lane, the drive begins where roads lie
///         above one another, or passes over itself.
map::Ground road_under(const map::RoadMap& road_map, const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::map::occupancy::ground
