#pragma once

// Private to map/occupancy/ground.

#include <vector>

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::map::inline occupancy::inline ground {

/// Poses of a drive, at most a metre of way apart: its start, its end and places between.
std::vector<geometry::Pose2> places_along(const geometry::Trajectory& drive);

}  // namespace roadbed::map::occupancy::ground
