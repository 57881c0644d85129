#include "roadbed/planning/obstacles/obstacle.h"

#include <cmath>
#include <utility>
#include <vector>

namespace roadbed::planning::inline obstacles {
namespace {

template <Frame kTo, Frame kFrom, typename Move>
ObstacleIn<kTo> moved(const ObstacleIn<kFrom>& obstacle, const Move& move) {
  std::vector<geometry::TrajectoryPoint> points = obstacle.motion.points();
  for (geometry::TrajectoryPoint& point : points) {
    const Eigen::Vector2d place = move(point.pose().position());
    point.x_m = place.x();
    point.y_m = place.y();
  }
  return {.id = obstacle.id,
          .kind = obstacle.kind,
          .length_m = obstacle.length_m,
          .width_m = obstacle.width_m,
          .motion = geometry::Trajectory(std::move(points)),
          .validity = obstacle.validity};
}

}  // namespace

geometry::Rectangle body_around(const geometry::Pose2& centre, double length_m, double width_m) {
  return {.centre = centre.position(),
          .axis = {std::cos(centre.heading_rad), std::sin(centre.heading_rad)},
          .half_length_m = 0.5 * length_m,
          .half_width_m = 0.5 * width_m};
}

ObstacleInSource obstacle_in_source(const map::RoadMap& road_map, const Obstacle& obstacle) {
  return moved<Frame::source>(
      obstacle, [&](const Eigen::Vector2d& in_map) { return road_map.to_source(in_map); });
}

Obstacle obstacle_in_map(const map::RoadMap& road_map, const ObstacleInSource& obstacle) {
  return moved<Frame::map>(
      obstacle, [&](const Eigen::Vector2d& in_source) { return road_map.to_map(in_source); });
}

}  // namespace roadbed::planning::obstacles
