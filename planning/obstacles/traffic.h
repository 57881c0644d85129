#pragma once

#include <span>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// Obstacles as the planner foresees them: where each will be, and from when to when it is there.
struct Traffic {
  std::span<const Obstacle> obstacles;
};

}  // namespace roadbed::planning::obstacles
