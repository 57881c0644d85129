#include "roadbed/planning/lateral/path_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Trajectory;
using geometry::TrajectoryPoint;

constexpr double kStopStep_s = 0.05;
constexpr double kLeastStretch = 0.05;  // of a path that is all but folded
constexpr double kLeastSpeed_mps = 0.05;

// The vehicle on a path, and how far it drives per metre of station.
struct PlaceOnPath {
  TrajectoryPoint point;
  double stretch;
};

PlaceOnPath place_on(const DrivenPath& driven, double s_m) {
  LateralState at = driven.path(s_m);
  const ReferencePoint on_line = driven.line.at(s_m);
  const double cos = std::cos(on_line.heading_rad), sin = std::sin(on_line.heading_rad);
  const double along = 1.0 - on_line.curvature_per_m * at.d_m;
  const auto curve = geometry::offset_curve(
      curvatures(on_line), {at.d_m, at.d_slope, at.d_curvature_per_m, 0.0, 0.0, 0.0},
      kLeastUnfolded);
  const double curvature = curve ? curve->curvature_per_m : 0.0;
  return {{.x_m = on_line.in_map.x() - at.d_m * sin,
           .y_m = on_line.in_map.y() + at.d_m * cos,
           .heading_rad = on_line.heading_rad + std::atan2(at.d_slope, along),
           .steering_rad = std::atan(driven.vehicle.wheelbase_m * curvature),
           .curvature_per_m = curvature},
          std::max(kLeastStretch, std::hypot(along, at.d_slope))};
}

}  // namespace

Trajectory stopping_drive(const DrivenPath& driven, double speed_mps, double deceleration_mps2,
                          double until_s) {
  const double stop_s = speed_mps / deceleration_mps2;
  const auto driven_m = [&](double t_s) {
    return t_s * (speed_mps - 0.5 * deceleration_mps2 * t_s);
  };
  const int steps = static_cast<int>(std::ceil(stop_s / kStopStep_s - 1e-6));
  std::vector<TrajectoryPoint> points;
  double s_m = driven.start_s_m, last_t_s = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = std::min(stop_s, kStopStep_s * i);
    PlaceOnPath place = place_on(driven, s_m);
    place.point.t_s = driven.start_t_s + t_s;
    place.point.speed_mps = std::max(0.0, speed_mps - deceleration_mps2 * t_s);
    place.point.acceleration_mps2 = t_s < stop_s ? -deceleration_mps2 : 0.0;
    points.push_back(place.point);
    const double next_t_s = std::min(stop_s, kStopStep_s * (i + 1));
    s_m += (driven_m(next_t_s) - driven_m(t_s)) / place.stretch;
    last_t_s = t_s;
  }
  TrajectoryPoint standing = points.back();
  standing.speed_mps = standing.acceleration_mps2 = 0.0;
  standing.t_s = driven.start_t_s + std::max(until_s, last_t_s + kStopStep_s);
  points.push_back(standing);
  return Trajectory(std::move(points));
}

Trajectory passing_drive(const DrivenPath& driven, const PlannedSpeed& speed, double end_s_m,
                         double until_s) {
  std::vector<TrajectoryPoint> points;
  double driven_m = 0.0, t_s = 0.0;
  // The sample behind `until_s` ends the segment that leads past it: without it a vehicle that
  // stands would have no segment, and touch nothing.
  bool is_over = false;
  for (double s_m = driven.start_s_m; s_m < end_s_m && !is_over; s_m += kPassStep_m) {
    is_over = t_s > until_s;
    PlaceOnPath place = place_on(driven, s_m);
    const PlannedSpeed::State state = speed.at(driven_m);
    place.point.t_s = driven.start_t_s + t_s;
    place.point.speed_mps = state.speed_mps;
    place.point.acceleration_mps2 = state.acceleration_mps2;
    points.push_back(place.point);
    const double step_m = kPassStep_m * place.stretch;
    const double mean_mps = 0.5 * (state.speed_mps + speed.at(driven_m + step_m).speed_mps);
    t_s += step_m / std::max(mean_mps, kLeastSpeed_mps);
    driven_m += step_m;
  }
  return Trajectory(std::move(points));
}

}  // namespace roadbed::planning::lateral
