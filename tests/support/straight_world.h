#pragma once

#include <vector>

#include "roadbed/tools/simulation/world.h"

namespace roadbed::tests {

/// A straight one-way road along the x axis, and the way along it.
struct StraightRoad {
  double from_x_m = 0.0, to_x_m = 260.0;
  double width_m = 4.0;
  double start_x_m = 10.0, goal_x_m = 200.0;
};

/// The road with a route from start to goal, its reference line and obstacles.
tools::World straight_world(const StraightRoad& road, std::vector<planning::Obstacle> obstacles);

}  // namespace roadbed::tests
