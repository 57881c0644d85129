#include "roadbed/planning/reference/speed_ceiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roadbed::planning::inline reference {
namespace {

void check(const std::vector<double>& caps_mps, double step_m, double deceleration_mps2) {
  const bool usable =
      caps_mps.size() >= 2 && step_m > 0.0 && deceleration_mps2 > 0.0 &&
      std::all_of(caps_mps.begin(), caps_mps.end(), [](double v) { return v >= 0.0; });
  if (!usable) {
    throw std::invalid_argument(
        fmt::format("SpeedCeiling: needs 2 or more speeds ≥ 0, a positive step and deceleration, "
                    "got {} speeds, {} m, {} m/s²",
                    caps_mps.size(), step_m, deceleration_mps2));
  }
}

double bend_speed_mps(const ReferencePoint& point, const geometry::VehicleShape& vehicle,
                      const SpeedCeilingOptions& options) {
  const double bend = std::max(std::abs(point.curvature_per_m), 1e-9);
  const double by_acceleration = std::sqrt(options.max_lateral_acceleration_mps2 / bend);
  const double turn = vehicle.wheelbase_m * point.curvature_per_m;
  const double steering_per_m =
      vehicle.wheelbase_m * std::abs(point.curvature_d1_per_m2) / (1.0 + turn * turn);
  const double by_steering = options.steering_rate_fraction * vehicle.max_steering_rate_radps /
                             std::max(steering_per_m, 1e-9);
  return std::min(by_acceleration, by_steering);
}

}  // namespace

SpeedCeiling::SpeedCeiling(const std::vector<double>& caps_mps, double step_m,
                           double deceleration_mps2)
    : squared_(caps_mps.size()), step_m_(step_m) {
  check(caps_mps, step_m, deceleration_mps2);
  double ahead = std::numeric_limits<double>::infinity();
  for (std::size_t i = caps_mps.size(); i-- > 0;) {
    squared_[i] = std::min(caps_mps[i] * caps_mps[i], ahead);
    ahead = squared_[i] + 2.0 * deceleration_mps2 * step_m;
  }
}

SpeedTarget SpeedCeiling::at(double s_m) const {
  const double last = static_cast<double>(squared_.size() - 1);
  const double place = std::clamp(s_m / step_m_, 0.0, last);
  const auto i = std::min(static_cast<std::size_t>(place), squared_.size() - 2);
  const double fraction = place - static_cast<double>(i);
  const double squared = squared_[i] + fraction * (squared_[i + 1] - squared_[i]);
  const double slope = (squared_[i + 1] - squared_[i]) / step_m_;
  return {.speed_mps = std::sqrt(squared), .acceleration_mps2 = std::min(0.0, 0.5 * slope)};
}

SpeedCeiling speed_ceiling(const ReferenceLine& line, const geometry::VehicleShape& vehicle,
                           const SpeedCeilingOptions& options) {
  std::vector<double> caps;
  for (double s = 0.0; s < line.length_m() + options.step_m; s += options.step_m) {
    caps.push_back(std::min({options.desired_speed_mps, line.corridor_at(s).speed_limit_mps,
                             bend_speed_mps(line.at(s), vehicle, options)}));
  }
  if (caps.size() < 2) caps.resize(2, caps.front());
  return SpeedCeiling(caps, options.step_m, options.deceleration_mps2);
}

SpeedTarget stopping_speed(double distance_m, double deceleration_mps2, double fade_s) {
  if (distance_m <= 0.0) return {};
  // Where the approach alone asks for the full deceleration.
  const double handover_mps = deceleration_mps2 * fade_s;
  const double handover_m = handover_mps * fade_s;
  if (distance_m < handover_m) {
    const double speed = distance_m / fade_s;
    return {speed, -speed / fade_s};
  }
  const double squared =
      handover_mps * handover_mps + 2.0 * deceleration_mps2 * (distance_m - handover_m);
  return {std::sqrt(squared), -deceleration_mps2};
}

}  // namespace roadbed::planning::reference
