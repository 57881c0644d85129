#include "roadbed/geometry/motion/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::geometry::inline motion {
namespace {

bool is_finite(const TrajectoryPoint& p) {
  return std::isfinite(p.t_s) && std::isfinite(p.x_m) && std::isfinite(p.y_m) &&
         std::isfinite(p.heading_rad) && std::isfinite(p.speed_mps) &&
         std::isfinite(p.acceleration_mps2) && std::isfinite(p.steering_rad) &&
         std::isfinite(p.curvature_per_m);
}

}  // namespace

TrajectoryPoint interpolate(const TrajectoryPoint& a, const TrajectoryPoint& b, double fraction) {
  const auto mix = [fraction](double from, double to) { return from + fraction * (to - from); };
  return {mix(a.t_s, b.t_s),
          mix(a.x_m, b.x_m),
          mix(a.y_m, b.y_m),
          mix(a.heading_rad, b.heading_rad),
          mix(a.speed_mps, b.speed_mps),
          mix(a.acceleration_mps2, b.acceleration_mps2),
          mix(a.steering_rad, b.steering_rad),
          mix(a.curvature_per_m, b.curvature_per_m)};
}

Trajectory::Trajectory(std::vector<TrajectoryPoint> points) : points_(std::move(points)) {
  if (points_.empty()) throw std::invalid_argument("Trajectory: needs at least 1 point, got 0");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!is_finite(points_[i])) {
      throw std::invalid_argument(fmt::format("Trajectory: a value of point {} is not finite", i));
    }
    if (i == 0) continue;
    if (!(points_[i].t_s > points_[i - 1].t_s)) {
      throw std::invalid_argument(
          fmt::format("Trajectory: time must increase, but point {} is at {} s after {} s", i,
                      points_[i].t_s, points_[i - 1].t_s));
    }
    const double before_rad = points_[i - 1].heading_rad;
    points_[i].heading_rad = before_rad + wrap_angle(points_[i].heading_rad - before_rad);
  }
}

TrajectoryPoint Trajectory::at(double t_s) const {
  if (t_s <= start_s()) return points_.front();
  if (t_s >= end_s()) return points_.back();
  const auto after = std::upper_bound(
      points_.begin(), points_.end(), t_s,
      [](double time_s, const TrajectoryPoint& point) { return time_s < point.t_s; });
  const TrajectoryPoint& b = *after;
  const TrajectoryPoint& a = *(after - 1);
  return interpolate(a, b, (t_s - a.t_s) / (b.t_s - a.t_s));
}

}  // namespace roadbed::geometry::motion
