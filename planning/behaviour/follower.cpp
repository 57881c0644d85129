#include "roadbed/planning/behaviour/follower.h"

#include <cmath>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kLeastAlongLine = 0.8;  // cosine

}  // namespace

bool is_following(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle) {
  const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
  const Eigen::Vector2d place = now.pose().position();
  const ReferencePoint foot = vehicle.line.at(vehicle.line.project(place).s_m);
  const Eigen::Vector2d along(std::cos(foot.heading_rad), std::sin(foot.heading_rad));
  const Eigen::Vector2d beyond = place - foot.in_map;  // along: before the line's first point
  const double d_m = along.x() * beyond.y() - along.y() * beyond.x();
  return foot.s_m + along.dot(beyond) < vehicle.s_m &&
         std::abs(d_m - vehicle.d_m) < 0.5 * (vehicle.width_m + obstacle.width_m) &&
         std::cos(now.heading_rad - foot.heading_rad) > kLeastAlongLine;
}

}  // namespace roadbed::planning::behaviour
