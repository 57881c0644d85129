#pragma once

#include <limits>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// A box that is there for a while, in source coordinates; what stands still may be there for ever.
struct MovingObstacle {
  Obstacle obstacle;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
};

/// The obstacle with its motion moved from the map's frame to source coordinates.
Obstacle obstacle_in_source(const map::RoadMap& road_map, const Obstacle& obstacle);

}  // namespace roadbed::planning::obstacles
