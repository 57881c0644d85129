#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline ground {

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
