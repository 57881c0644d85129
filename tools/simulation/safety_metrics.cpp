#include "roadbed/tools/simulation/safety_metrics.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/behaviour/lead.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Rectangle;

constexpr double kLook_s = 3.0, kLookStep_s = 0.1;
constexpr double kLeastSpeed_mps = 1.0;

Rectangle moved(Rectangle body, const Eigen::Vector2d& velocity_mps, double duration_s) {
  body.centre += duration_s * velocity_mps;
  return body;
}

Eigen::Vector2d velocity_of(const planning::Obstacle& obstacle, double t_s) {
  if (obstacle.is_static()) return {0.0, 0.0};
  const geometry::TrajectoryPoint at = obstacle.motion.at(t_s);
  return at.speed_mps * Eigen::Vector2d(std::cos(at.heading_rad), std::sin(at.heading_rad));
}

/// First time at which two bodies touch, less than `within_s`.
std::optional<double> time_to_touch(const Rectangle& a, const Eigen::Vector2d& velocity_a,
                                    const Rectangle& b, const Eigen::Vector2d& velocity_b,
                                    double within_s) {
  const double reach = a.radius_m() + b.radius_m() + (velocity_b - velocity_a).norm() * within_s;
  if ((a.centre - b.centre).norm() > reach) return std::nullopt;
  const auto steps = static_cast<int>(std::lround(within_s / kLookStep_s));
  for (int k = 0; k < steps; ++k) {
    const double ahead_s = kLookStep_s * k;
    if (geometry::distance_m(moved(a, velocity_a, ahead_s), moved(b, velocity_b, ahead_s)) <= 0.0)
      return ahead_s;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Encounter> least_time_to_collision(const Drive& drive, const World& world,
                                                 const geometry::VehicleShape& vehicle) {
  std::optional<Encounter> least;
  double within_s = kLook_s + kLookStep_s;
  for (const geometry::TrajectoryPoint& row : drive.trajectory.points()) {
    const Eigen::Vector2d in_map = world.road_map.to_map({row.x_m, row.y_m});
    const Rectangle body = geometry::body_at({in_map.x(), in_map.y(), row.heading_rad}, vehicle);
    const Eigen::Vector2d velocity = row.speed_mps * body.axis;
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      if (!world.is_there(i, row.t_s)) continue;
      const auto touch = time_to_touch(body, velocity, rectangle_at(world.obstacles[i], row.t_s),
                                       velocity_of(world.obstacles[i], row.t_s), within_s);
      if (!touch) continue;
      least = Encounter{*touch, row.t_s};
      within_s = *touch;
    }
  }
  return least;
}

std::optional<Encounter> least_headway(const Drive& drive) {
  std::optional<Encounter> least;
  for (const DriveCycle& cycle : drive.cycles) {
    const double speed = drive.trajectory.at(cycle.t_s).speed_mps;
    if (!cycle.lead || speed < kLeastSpeed_mps) continue;
    const double headway_s = cycle.lead->gap_m / speed;
    if (!least || headway_s < least->time_s) least = Encounter{headway_s, cycle.t_s};
  }
  return least;
}

double wrong_way_m(const Drive& drive) {
  double back_m = 0.0;
  for (std::size_t i = 1; i < drive.samples.size(); ++i) {
    back_m += std::max(0.0, drive.samples[i - 1].s_m - drive.samples[i].s_m);
  }
  return back_m;
}

}  // namespace roadbed::tools
