#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// Obstacles as the planner foresees them: where each will be, and from when to when it is there.
struct Traffic {
  std::span<const Obstacle> obstacles;
};

/// A body that is there, and which obstacle it is of.
struct BodyThere {
  std::size_t obstacle = 0;
  geometry::Rectangle body;
};

/// All bodies at a time. Several motions that somebody may make stand one after the other and begin
/// in one place: of those the first is given.
std::vector<BodyThere> bodies_there(std::span<const Obstacle> obstacles, double t_s);

}  // namespace roadbed::planning::obstacles
