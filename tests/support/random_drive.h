#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <random>

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::tests {

/// How far a random drive goes from row to row: each component uniformly within ± these.
struct DriveSteps {
  std::size_t rows = 1;  // after the first one
  double step_s = 1.0;   // between rows
  double way_m = 1.0;    // along x and along y
  double turn_rad = 1.0;
};

/// A point in the square of ± `spread_m` around a place, headed within ± `heading_rad`, at 0 s.
geometry::TrajectoryPoint random_start(std::mt19937& random, const Eigen::Vector2d& around,
                                       double spread_m, double heading_rad);

/// A drive from `first` on. Rows take their way along x, along y, and turn, in this order.
geometry::Trajectory random_drive(std::mt19937& random, const geometry::TrajectoryPoint& first,
                                  const DriveSteps& steps);

}  // namespace roadbed::tests
