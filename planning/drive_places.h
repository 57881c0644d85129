#pragma once

// Private to planning.

#include <vector>

#include "roadbed/geometry/trajectory.h"

namespace roadbed::planning {

/// Poses of a drive, at most a metre of way apart: its start, its end and places between.
std::vector<geometry::Pose2> places_along(const geometry::Trajectory& drive);

}  // namespace roadbed::planning
