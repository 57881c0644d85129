#pragma once

// Private to map/occupancy/ground: what the makers of a drive's ground share.

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline ground {

/// Poses of a drive, at most a metre of way apart: its start, its end and places between.
std::vector<geometry::Pose2> places_along(const geometry::Trajectory& drive);

/// Height of a place's plane at a point.
double plane_at(const map::GroundPlace& plane, const Eigen::Vector2d& point);

/// @throws InputError always: the ground cannot be told at a place.
[[noreturn]] void refuse_ground(const Eigen::Vector2d& at, const std::string& found,
                                const std::string& needed);

/// A point beside the drive belongs to one place only.
/// @throws InputError if places near one another in plan are over half a metre apart in height.
void check_is_single(const std::vector<map::GroundPlace>& places);

}  // namespace roadbed::map::occupancy::ground
