#pragma once

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// An obstacle as recorded, and when it is there.
struct RecordedObstacle {
  planning::Obstacle obstacle;
  planning::TimeSpan presence;
};

/// An obstacle of a CommonRoad file as the smallest rectangle along its heading that holds its
/// shape. What moves is there from its first to its last recorded time step; what does not, always.
/// @param start_step  the time step that is second 0.
/// @pre it has an initial state and a shape.
RecordedObstacle recorded_obstacle(const map::commonroad::Obstacle& from,
                                   const map::RoadMap& road_map, long start_step, double step_s);

}  // namespace roadbed::tools
