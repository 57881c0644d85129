#include "roadbed/tools/simulation/obstacle_motion.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;

constexpr double kStep_s = 0.1;

/// Drives on straight to `next`, where the speed changes at once: a row just before it still has
/// the speed of the way there, as between rows speeds are linear.
void drive_on(std::vector<TrajectoryPoint>& points, const TrajectoryPoint& next) {
  constexpr double kAtOnce_s = 1e-3;
  TrajectoryPoint& from = points.back();
  const double duration_s = next.t_s - from.t_s;
  from.speed_mps = (next.pose().position() - from.pose().position()).norm() / duration_s;
  const double ratio = 1.0 - std::min(0.5, kAtOnce_s / duration_s);
  const double turn_rad = geometry::wrap_angle(next.heading_rad - from.heading_rad);
  points.push_back({.t_s = from.t_s + ratio * duration_s,
                    .x_m = from.x_m + ratio * (next.x_m - from.x_m),
                    .y_m = from.y_m + ratio * (next.y_m - from.y_m),
                    .heading_rad = from.heading_rad + ratio * turn_rad,
                    .speed_mps = from.speed_mps});
  points.push_back(next);
}

}  // namespace

double wanted_speed_mps(const std::vector<TimedSpeed>& speeds, double t_s) {
  const auto after = std::find_if(speeds.begin(), speeds.end(),
                                  [&](const TimedSpeed& speed) { return speed.t_s > t_s; });
  if (after == speeds.begin()) return speeds.front().speed_mps;
  if (after == speeds.end()) return speeds.back().speed_mps;
  const TimedSpeed& before = *std::prev(after);
  const double fraction = (t_s - before.t_s) / (after->t_s - before.t_s);
  return before.speed_mps + fraction * (after->speed_mps - before.speed_mps);
}

double travelled_m(const std::vector<TimedSpeed>& speeds, double t_s) {
  // Trapezoids between 0, the times within, and t.
  double distance = 0.0, from_s = 0.0;
  const auto drive_to = [&](double to_s) {
    distance +=
        0.5 * (wanted_speed_mps(speeds, from_s) + wanted_speed_mps(speeds, to_s)) * (to_s - from_s);
    from_s = to_s;
  };
  for (const TimedSpeed& speed : speeds) {
    if (speed.t_s > from_s && speed.t_s < t_s) drive_to(speed.t_s);
  }
  drive_to(t_s);
  return distance;
}

geometry::Trajectory drive_along(const Way& way, double way_length_m,
                                 const std::vector<TimedSpeed>& speeds, double duration_s) {
  std::vector<TrajectoryPoint> points;
  const auto steps = static_cast<std::size_t>(std::ceil(duration_s / kStep_s));
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t_s = kStep_s * static_cast<double>(k);
    const double distance = travelled_m(speeds, t_s);
    const Pose2 pose = way(std::min(distance, way_length_m));
    points.push_back({.t_s = t_s,
                      .x_m = pose.x_m,
                      .y_m = pose.y_m,
                      .heading_rad = pose.heading_rad,
                      .speed_mps = distance < way_length_m ? wanted_speed_mps(speeds, t_s) : 0.0});
  }
  return geometry::Trajectory(std::move(points));
}

geometry::Trajectory drive_through(const std::vector<TimedPose>& poses_in_map) {
  std::vector<TrajectoryPoint> points;
  for (const TimedPose& timed : poses_in_map) {
    const TrajectoryPoint next{.t_s = timed.t_s,
                               .x_m = timed.pose.x_m,
                               .y_m = timed.pose.y_m,
                               .heading_rad = timed.pose.heading_rad};
    if (points.empty()) {
      points.push_back(next);
    } else {
      drive_on(points, next);
    }
  }
  return geometry::Trajectory(std::move(points));
}

}  // namespace roadbed::tools::simulation
