#pragma once

#include <span>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline pilot {

/// When a drive first meets somebody, not counting who comes from behind [s of scene time];
/// infinite: nobody. At the drive's rows only. O(rows · obstacles).
double first_contact_s(const geometry::Trajectory& drive, const geometry::VehicleShape& vehicle,
                       std::span<const Obstacle> obstacles);

}  // namespace roadbed::planning::pilot
