#pragma once

#include <limits>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// A box that is there for a while, in source coordinates; what stands still may be there for ever.
struct MovingObstacle {
  Obstacle obstacle;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
};

}  // namespace roadbed::planning::obstacles
