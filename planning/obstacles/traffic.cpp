#include "roadbed/planning/obstacles/traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/obstacles/foreseen_motion.h"

namespace roadbed::planning::inline obstacles {
namespace {

constexpr double kSeenPast_s = 0.3;
constexpr double kMostSpeedUp_mps2 = 2.5, kMostBraking_mps2 = 6.0;
constexpr double kRecordedNoise_mps = 0.05;  // slower is noise of a recording
constexpr double kNever_s = std::numeric_limits<double>::infinity();

/// Speed between two times, less than 0 for who backs up.
double mean_speed_mps(const geometry::TrajectoryPoint& before,
                      const geometry::TrajectoryPoint& after) {
  const Eigen::Vector2d moved = after.pose().position() - before.pose().position();
  const Eigen::Vector2d along{std::cos(after.heading_rad), std::sin(after.heading_rad)};
  const double speed = std::copysign(moved.norm(), moved.dot(along)) / (after.t_s - before.t_s);
  return std::abs(speed) < kRecordedNoise_mps ? 0.0 : speed;
}

/// Speed, its change and the bend over the last moments, pose of now.
SeenMotion seen_at(const geometry::Trajectory& motion, double from_s, double now_s) {
  const geometry::TrajectoryPoint now = motion.at(now_s);
  SeenMotion seen{.t_s = now_s, .pose = now.pose()};
  const double before_s = std::max(from_s, now_s - kSeenPast_s);
  if (now_s - before_s < 0.5 * kSeenPast_s) {  // just appeared: what it is said to do
    seen.speed_mps = now.speed_mps;
    return seen;
  }
  geometry::TrajectoryPoint before = motion.at(before_s);
  before.t_s = before_s;
  geometry::TrajectoryPoint at = now;
  at.t_s = now_s;
  seen.speed_mps = mean_speed_mps(before, at);
  if (seen.speed_mps == 0.0) return seen;
  seen.curvature_per_m = geometry::wrap_angle(now.heading_rad - before.heading_rad) /
                         (seen.speed_mps * (now_s - before_s));
  if (before_s - kSeenPast_s < from_s - 1e-9) return seen;
  geometry::TrajectoryPoint earlier = motion.at(before_s - kSeenPast_s);
  earlier.t_s = before_s - kSeenPast_s;
  const double change = seen.speed_mps - mean_speed_mps(earlier, before);
  seen.acceleration_mps2 = std::clamp(change / kSeenPast_s, -kMostBraking_mps2, kMostSpeedUp_mps2);
  seen.speed_mps = std::max(0.0, seen.speed_mps + 0.5 * change);  // the mean is that of before
  return seen;
}

}  // namespace

PredictedTraffic::PredictedTraffic(const Traffic& truth, double now_s)
    : obstacles_(truth.obstacles.begin(), truth.obstacles.end()) {
  for (Obstacle& obstacle : obstacles_) {
    const TimeSpan truly = obstacle.validity;
    obstacle.validity = {kNever_s, -kNever_s};
    if (!truly.holds(now_s)) continue;
    obstacle.validity = {now_s, kNever_s};
    if (obstacle.is_static()) continue;
    // What is always there is seen since the drive begins.
    const double from_s = std::isinf(truly.from_s) ? 0.0 : truly.from_s;
    obstacle.motion = foreseen_motion(seen_at(obstacle.motion, from_s, now_s));
  }
}

}  // namespace roadbed::planning::obstacles
