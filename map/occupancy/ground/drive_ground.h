#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline ground {

/// The road's surface under a drive, from the lanes of a map with their heights, at places up to a
/// metre apart. Where roads lie above one another the drive stays on the one that it is on.
/// @throws InputError if a place is over 20 m from every lane, the drive begins where roads lie
///         above one another, or passes over itself.
map::Ground road_under(const map::RoadMap& road_map, const geometry::Trajectory& drive_in_source);

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

/// What speaks against a ground that a certificate claims for a drive: a pose of the drive over 2 m
/// from every place, a place over 2 m beyond the body's reach from every pose, a slope over 0.5, a
/// step over 0.5 m between places up to 2 m apart. It is not compared with anything measured.
/// Empty: nothing. O(N log N) for places that are not crowded.
std::vector<std::string> ground_faults(const map::Ground& ground,
                                       const geometry::Trajectory& drive_in_source, double reach_m);

/// The lowest and the highest z of a ground at the samples of a drive.
std::pair<double, double> heights_at_samples_m(const map::Ground& ground,
                                               const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::map::occupancy::ground
