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

}  // namespace roadbed::planning::obstacles
