#pragma once

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline ground {

/// How far a body reaches behind and before the rear axle's centre.
struct BodyReach {
  double rear_m = 0.0;  ///< negative behind the axle
  double front_m = 0.0;
};

/// The ground under all that a body passes, as it was measured: planes of least squares, at places
/// up to a metre apart, through the lowest occupied cell of each column within 2 m. A surface is
/// taken for ground only if nothing was measured below it, it is seen on all four sides of the
/// place and on one level, and it goes on from place to place without a step: so it is no obstacle
/// on the ground, but where a drive begins and ends upon one. Under a bridge that is the road
/// below.
/// @throws InputError with the place, and why there is no such surface.
map::Ground measured_under(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source, const BodyReach& body);

/// How far what `measured_under` says may lie above or below the ground: a cell, 5 cm at least.
double measured_ground_margin_m(double cell_m);

}  // namespace roadbed::map::occupancy::ground
