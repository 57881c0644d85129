#include "roadbed/tools/simulation/traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/angle.h"
#include "roadbed/planning/prediction.h"

namespace roadbed::tools {
namespace {

constexpr double kSeenFor_s = 0.3;
constexpr double kForeseen_s = 12.0, kForeseenStep_s = 0.2;
constexpr double kTurnsFor_s = 2.0;   // nobody turns for ever
constexpr double kStands_mps = 0.05;  // slower is noise of a recording
constexpr double kNever_s = std::numeric_limits<double>::infinity();

/// Speed and turn rate over the last moments, pose of now.
planning::ObservedMotion seen_at(const geometry::Trajectory& motion, double from_s, double now_s) {
  const geometry::TrajectoryPoint now = motion.at(now_s);
  planning::ObservedMotion seen{.t_s = now_s, .pose = now.pose()};
  const double before_s = std::max(from_s, now_s - kSeenFor_s);
  if (now_s - before_s < 0.5 * kSeenFor_s) {  // just appeared: what it is said to do
    seen.speed_mps = now.speed_mps;
    return seen;
  }
  const geometry::TrajectoryPoint before = motion.at(before_s);
  const Eigen::Vector2d moved = now.pose().position() - before.pose().position();
  const Eigen::Vector2d along{std::cos(now.heading_rad), std::sin(now.heading_rad)};
  seen.speed_mps = std::copysign(moved.norm(), moved.dot(along)) / (now_s - before_s);
  if (std::abs(seen.speed_mps) < kStands_mps) seen.speed_mps = 0.0;
  if (seen.speed_mps != 0.0) {
    seen.turn_rate_radps =
        geometry::wrap_angle(now.heading_rad - before.heading_rad) / (now_s - before_s);
  }
  return seen;
}

geometry::Trajectory foreseen_motion(const planning::ObservedMotion& seen) {
  const auto turning = planning::Prediction::constant_turn(seen);
  const geometry::Pose2 turned = turning.at(seen.t_s + kTurnsFor_s);
  const auto straight = planning::Prediction::constant_velocity(
      {.t_s = seen.t_s + kTurnsFor_s, .pose = turned, .speed_mps = seen.speed_mps});
  std::vector<geometry::TrajectoryPoint> points;
  for (int k = 0; k * kForeseenStep_s <= kForeseen_s; ++k) {
    const double after_s = k * kForeseenStep_s, t_s = seen.t_s + after_s;
    const geometry::Pose2 pose = (after_s <= kTurnsFor_s ? turning : straight).at(t_s);
    points.push_back({.t_s = t_s,
                      .x_m = pose.x_m,
                      .y_m = pose.y_m,
                      .heading_rad = pose.heading_rad,
                      .speed_mps = seen.speed_mps});
    if (seen.speed_mps == 0.0) break;  // one point: it stands
  }
  return geometry::Trajectory(std::move(points));
}

}  // namespace

Traffic true_traffic(const World& world) { return {world.obstacles, world.presence}; }

ForeseenTraffic::ForeseenTraffic(const Traffic& truth, double now_s)
    : obstacles_(truth.obstacles.begin(), truth.obstacles.end()) {
  presence_.assign(obstacles_.size(), {kNever_s, -kNever_s});
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    if (!truth.is_there(i, now_s)) continue;
    presence_[i] = {now_s, kNever_s};
    if (obstacles_[i].is_static()) continue;
    const double from_s = truth.presence.empty() ? 0.0 : truth.presence[i].from_s;
    obstacles_[i].motion = foreseen_motion(seen_at(truth.obstacles[i].motion, from_s, now_s));
  }
}

}  // namespace roadbed::tools
