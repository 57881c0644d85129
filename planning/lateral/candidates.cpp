#include "roadbed/planning/lateral/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace roadbed::planning::inline lateral {
namespace {

constexpr double kSlowest_mps = 0.05;  // mean over a section; a standing vehicle creeps, for times

// The slack lets an end of the range count that is a multiple but for rounding (0.3 / 0.1 < 3).
// Multiples of `step` in [from, to].
std::vector<double> multiples(const char* what, double step, double from, double to) {
  const bool finite = std::isfinite(step) && std::isfinite(from) && std::isfinite(to);
  if (!finite || !(step > 0.0) || from > to || (to - from) / step > 1e5) {
    throw std::invalid_argument(
        fmt::format("plan: the range of {} is not usable: from {} m to {} m in steps of {} m", what,
                    from, to, step));
  }
  std::vector<double> values;
  const auto first = static_cast<long>(std::ceil(from / step - kLimitSlack));
  const auto last = static_cast<long>(std::floor(to / step + kLimitSlack));
  for (long i = first; i <= last; ++i) values.push_back(static_cast<double>(i) * step);
  if (values.empty()) {
    throw std::invalid_argument(fmt::format(
        "plan: no multiple of {} m between {} m and {} m for {}", step, from, to, what));
  }
  return values;
}

geometry::Quintic::Derivatives offset_at(const geometry::Quintic& quintic, double l_m) {
  if (l_m <= quintic.length()) return quintic.at(l_m);
  return {quintic.at(quintic.length())[0], 0.0, 0.0, 0.0, 0.0, 0.0};
}

bool is_off_road(const std::vector<Station>& stations, const geometry::Quintic& quintic) {
  return std::ranges::any_of(stations, [&](const Station& station) {
    const double d_m = quintic.at(station.l_m)[0];
    return !(d_m >= station.min_d_m - kLimitSlack && d_m <= station.max_d_m + kLimitSlack);
  });
}

// tan δ = L k, so δ̇ = L v dk/dσ / (1 + L² k²).
double steering_rate_radps(const CostPoint& point, double wheelbase_m) {
  const double tangent = wheelbase_m * point.curvature_per_m;
  return std::abs(wheelbase_m * point.speed_mps * point.curvature_d1_per_m2) /
         (1.0 + tangent * tangent);
}

geometry::TrajectoryPoint trajectory_point(const Station& station, double d_m,
                                           const geometry::OffsetCurve& curve, double wheelbase_m) {
  const double heading_rad = station.line.heading_rad;
  const Eigen::Vector2d in_map =
      station.line.in_map + d_m * Eigen::Vector2d(-std::sin(heading_rad), std::cos(heading_rad));
  return {.t_s = 0.0,
          .x_m = in_map.x(),
          .y_m = in_map.y(),
          .heading_rad = heading_rad + std::atan2(curve.across, curve.along),
          .speed_mps = station.speed.speed_mps,
          .acceleration_mps2 = station.speed.acceleration_mps2,
          .steering_rad = std::atan(wheelbase_m * curve.curvature_per_m),
          .curvature_per_m = curve.curvature_per_m};
}

}  // namespace

std::string_view to_string(Rejection rejection) {
  constexpr std::array<std::string_view, kRejections> kNames = {
      "none", "off_road", "beyond_curvature", "lateral_acceleration", "steering_rate", "collision"};
  return kNames.at(static_cast<std::size_t>(rejection));
}

bool is_preferred(const Candidate& a, const Candidate& b) {
  const double side_a = std::abs(a.end_d_m), side_b = std::abs(b.end_d_m);
  if (side_a != side_b) return side_a < side_b;
  if (a.end_l_m != b.end_l_m) return a.end_l_m > b.end_l_m;
  return a.end_d_m > b.end_d_m;
}

Grid::Grid(const GridRange& range)
    : end_d_m_(multiples("d_e", range.d_step_m, range.min_d_m, range.max_d_m)),
      end_l_m_(multiples("l_e", range.l_step_m, range.min_l_m, range.max_l_m)) {
  if (!(end_l_m_.front() > 0.0)) {
    throw std::invalid_argument(
        fmt::format("plan: l_e must be positive, its range begins at {} m", range.min_l_m));
  }
}

DrivingLimits driving_limits(const geometry::VehicleShape& vehicle,
                             double max_lateral_acceleration_mps2) {
  return {.max_curvature_per_m = std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m,
          .max_lateral_acceleration_mps2 = max_lateral_acceleration_mps2,
          .wheelbase_m = vehicle.wheelbase_m};
}

// Who starts outside of the corridor has `recovery_m` to come back, linearly. Without it no
// candidate would be within the road at l = 0, and none could lead back.
double allowed_excess_m(const CycleContext& context, double l_m) {
  return context.start_excess_m * std::max(0.0, 1.0 - l_m / context.recovery_m);
}

OffsetRange offsets_on_road(const CycleContext& context, double l_m) {
  const Corridor corridor = context.line.corridor_at(context.start.s_m + l_m);
  const double inward_m = context.half_width_m - allowed_excess_m(context, l_m);
  return {inward_m - corridor.right_m, corridor.left_m - inward_m};
}

Station station_at(const CycleContext& context, double l_m) {
  const double s_m = context.start.s_m + l_m;
  const OffsetRange range = offsets_on_road(context, l_m);
  Station station{.l_m = l_m,
                  .line = context.line.at(s_m),
                  .speed = context.speed.at(l_m),
                  .previous_d_m = {},
                  .min_d_m = range.min_d_m,
                  .max_d_m = range.max_d_m};
  if (context.previous_d_m) station.previous_d_m = context.previous_d_m(s_m);
  return station;
}

std::vector<Station> stations_over(const CycleContext& context, double end_l_m, int count) {
  std::vector<Station> stations;
  stations.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    stations.push_back(station_at(context, end_l_m * i / (count - 1)));
  }
  return stations;
}

QuinticFamily::QuinticFamily(const LateralState& start, double end_l_m)
    : at_zero({start.d_m, start.d_slope, start.d_curvature_per_m}, {}, end_l_m),
      per_unit({}, {.value = 1.0}, end_l_m) {}

geometry::Quintic QuinticFamily::member(double end_d_m) const {
  const auto& c = at_zero.coefficients();
  return {{c[0], c[1], 2.0 * c[2]}, {.value = end_d_m}, at_zero.length()};
}

geometry::CurvatureDerivatives curvatures(const ReferencePoint& point) {
  return {point.curvature_per_m, point.curvature_d1_per_m2, point.curvature_d2_per_m3,
          point.curvature_d3_per_m4, point.curvature_d4_per_m5};
}

std::vector<CostPoint> cost_points(const std::vector<Station>& stations,
                                   const geometry::Quintic& quintic) {
  std::vector<CostPoint> points;
  points.reserve(stations.size());
  for (const Station& station : stations) {
    const auto offset = quintic.at(station.l_m);
    const auto curve = geometry::offset_curve(curvatures(station.line), offset, kLeastUnfolded);
    if (!curve) return {};
    points.push_back({.d_m = offset[0],
                      .previous_d_m = station.previous_d_m.value_or(offset[0]),
                      .stretch = curve->stretch,
                      .curvature_per_m = curve->curvature_per_m,
                      .curvature_d1_per_m2 = curve->curvature_d1_per_m2,
                      .curvature_d2_per_m3 = curve->curvature_d2_per_m3,
                      .curvature_d3_per_m4 = curve->curvature_d3_per_m4,
                      .speed_mps = station.speed.speed_mps,
                      .acceleration_mps2 = station.speed.acceleration_mps2,
                      .jerk_mps3 = station.speed.jerk_mps3});
  }
  return points;
}

Rejection judge(const std::vector<Station>& stations, const geometry::Quintic& quintic,
                const std::vector<CostPoint>& points, const DrivingLimits& limits) {
  if (is_off_road(stations, quintic)) return Rejection::off_road;
  if (points.empty()) return Rejection::beyond_curvature;
  double curvature_per_m = 0.0, lateral_mps2 = 0.0, steering_radps = 0.0;
  for (const CostPoint& point : points) {
    const double curvature = std::abs(point.curvature_per_m);
    curvature_per_m = std::max(curvature_per_m, curvature);
    lateral_mps2 = std::max(lateral_mps2, point.speed_mps * point.speed_mps * curvature);
    steering_radps = std::max(steering_radps, steering_rate_radps(point, limits.wheelbase_m));
  }
  if (curvature_per_m > limits.max_curvature_per_m) return Rejection::beyond_curvature;
  if (lateral_mps2 > limits.max_lateral_acceleration_mps2) return Rejection::lateral_acceleration;
  if (steering_radps > limits.max_steering_rate_radps) return Rejection::steering_rate;
  return Rejection::none;
}

double mean_speed_mps(const Station& from, const Station& to) {
  return std::max(0.5 * (from.speed.speed_mps + to.speed.speed_mps), kSlowest_mps);
}

std::vector<geometry::TrajectoryPoint> drive_along(const std::vector<Station>& stations,
                                                   const geometry::Quintic& quintic,
                                                   double start_t_s, double wheelbase_m) {
  std::vector<geometry::TrajectoryPoint> drive;
  drive.reserve(stations.size());
  double t_s = start_t_s, last_stretch = 0.0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto offset = offset_at(quintic, stations[i].l_m);
    const auto curve = geometry::offset_curve(curvatures(stations[i].line), offset, kLeastUnfolded);
    if (!curve && stations[i].l_m > quintic.length()) break;
    if (!curve) return {};
    drive.push_back(trajectory_point(stations[i], offset[0], *curve, wheelbase_m));
    if (i > 0) {
      const double length_m =
          0.5 * (last_stretch + curve->stretch) * (stations[i].l_m - stations[i - 1].l_m);
      t_s += length_m / mean_speed_mps(stations[i - 1], stations[i]);
    }
    drive.back().t_s = t_s;
    last_stretch = curve->stretch;
  }
  return drive;
}

}  // namespace roadbed::planning::lateral
