#pragma once

#include "roadbed/geometry/trajectory.h"
#include "roadbed/map/occupancy/ground.h"
#include "roadbed/map/occupancy/occupancy_map.h"
#include "roadbed/map/road_map.h"

namespace roadbed::planning {

/// The road's surface under a drive, from the lanes of a map with their heights, at places up to a
/// metre apart. Where roads lie above one another the drive stays on the one that it is on.
/// @throws InputError if a place is over 20 m from every lane, the drive begins where roads lie
///         above one another, or passes over itself.
map::Ground road_under(const map::RoadMap& road_map, const geometry::Trajectory& drive_in_source);

/// The ground under a drive as it was measured: a plane through the lowest occupied cell of each
/// column around a place, robust against things that hide the ground there [trimmed least squares,
/// as in Rousseeuw 1984], to about half a cell. Under a bridge that is the road below.
/// @throws InputError where there are too few such cells, or they are no plane.
map::Ground measured_under(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::planning
