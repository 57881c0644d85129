#include "roadbed/planning/obstacles/moving_obstacle.h"

#include <utility>
#include <vector>

namespace roadbed::planning::inline obstacles {

Obstacle obstacle_in_source(const map::RoadMap& road_map, const Obstacle& obstacle) {
  Obstacle moved = obstacle;
  std::vector<geometry::TrajectoryPoint> points = obstacle.motion.points();
  for (geometry::TrajectoryPoint& point : points) {
    const Eigen::Vector2d place = road_map.to_source(point.pose().position());
    point.x_m = place.x();
    point.y_m = place.y();
  }
  moved.motion = geometry::Trajectory(std::move(points));
  return moved;
}

}  // namespace roadbed::planning::obstacles
