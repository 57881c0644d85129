#include "roadbed/planning/obstacles/foreseen_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace roadbed::planning::inline obstacles {
namespace {

constexpr int kSubsteps = 4;
constexpr double kTurnsFor_s = 2.0;  // nobody turns for ever
constexpr double kSpeedsUpFor_s = 1.0, kBrakesFor_s = 2.0;
constexpr double kKeepsSpeedingUpFor_s = 4.0, kSpeedsUp_mps2 = 0.5;

/// Time for a way, speeding up from a speed for a while.
double time_for_s(double way_m, double speed_mps, double acceleration_mps2, double for_s) {
  const double faster_mps = speed_mps + acceleration_mps2 * for_s;
  const double until_m = 0.5 * (speed_mps + faster_mps) * for_s;
  if (way_m > until_m) return for_s + (way_m - until_m) / faster_mps;
  const double then_mps = std::sqrt(speed_mps * speed_mps + 2.0 * acceleration_mps2 * way_m);
  return (then_mps - speed_mps) / acceleration_mps2;
}

}  // namespace

double foreseen_speed_mps(const SeenMotion& seen, double after_s) {
  const double for_s = seen.acceleration_mps2 > 0.0 ? kSpeedsUpFor_s : kBrakesFor_s;
  const double speed = seen.speed_mps + seen.acceleration_mps2 * std::min(after_s, for_s);
  return seen.speed_mps > 0.0 ? std::max(0.0, speed) : seen.speed_mps;
}

geometry::Trajectory foreseen_motion(const SeenMotion& seen) {
  std::vector<geometry::TrajectoryPoint> points;
  geometry::Pose2 pose = seen.pose;
  const double step_s = kForeseenStep_s / kSubsteps;
  const auto steps = static_cast<int>(std::lround(kForeseen_s / step_s));
  for (int k = 0; k <= steps; ++k) {
    const double after_s = step_s * k;
    if (k % kSubsteps == 0) {
      points.push_back({.t_s = seen.t_s + after_s,
                        .x_m = pose.x_m,
                        .y_m = pose.y_m,
                        .heading_rad = pose.heading_rad,
                        .speed_mps = foreseen_speed_mps(seen, after_s)});
      if (seen.speed_mps == 0.0) break;  // one point: it stands
    }
    const double way_m = step_s * foreseen_speed_mps(seen, after_s + 0.5 * step_s);
    const double turn = after_s < kTurnsFor_s - 1e-9 ? way_m * seen.curvature_per_m : 0.0;
    const double heading = pose.heading_rad + 0.5 * turn;
    pose = {pose.x_m + way_m * std::cos(heading), pose.y_m + way_m * std::sin(heading),
            pose.heading_rad + turn};
  }
  return geometry::Trajectory(std::move(points));
}

std::optional<geometry::Trajectory> speeding_on(const geometry::Trajectory& foreseen,
                                                double from_s) {
  constexpr double over_s = 0.5;
  const geometry::TrajectoryPoint now = foreseen.at(from_s);
  const double acceleration_mps2 =
      (foreseen.at(from_s + over_s).speed_mps - now.speed_mps) / over_s;
  if (now.speed_mps < 0.0 || acceleration_mps2 < kSpeedsUp_mps2) return std::nullopt;
  std::vector<geometry::TrajectoryPoint> points{now};
  double way_m = 0.0;
  Eigen::Vector2d last = now.pose().position();
  for (geometry::TrajectoryPoint point : foreseen.points()) {
    if (point.t_s <= from_s) continue;
    way_m += (point.pose().position() - std::exchange(last, point.pose().position())).norm();
    const double after_s =
        time_for_s(way_m, now.speed_mps, acceleration_mps2, kKeepsSpeedingUpFor_s);
    point.t_s = from_s + after_s;
    point.speed_mps = now.speed_mps + acceleration_mps2 * std::min(after_s, kKeepsSpeedingUpFor_s);
    if (point.t_s > points.back().t_s) points.push_back(point);
  }
  return geometry::Trajectory(std::move(points));
}

}  // namespace roadbed::planning::obstacles
