#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tests {

/// Adds a lane `width_m` wide along an arc, densely sampled, z = 0.
/// @param curvature_per_m  positive to the left; 0: straight.
map::LaneId add_arc_lane(MadeMap& made, map::RoadId road, const std::string& source_id,
                         const geometry::Pose2& start, double curvature_per_m, double length_m,
                         double width_m);

/// A map of one road with arcs of random place, heading, curvature, length and width within
/// ±`extent_m`, not linked with each other.
MadeMap random_arc_lanes(std::mt19937& random, int count, double extent_m);

}  // namespace roadbed::tests
