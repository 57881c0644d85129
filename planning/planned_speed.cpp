#include "roadbed/planning/planned_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roadbed::planning {
namespace {

constexpr double kFadeTime_s = 1.0;
constexpr double kLeastFade_m = 1.0;  // for a target of standstill

void check(const SpeedPlan& plan) {
  const bool finite = std::isfinite(plan.speed_mps) && std::isfinite(plan.acceleration_mps2) &&
                      std::isfinite(plan.target_mps);
  if (!finite || plan.speed_mps < 0.0 || plan.target_mps < 0.0) {
    throw std::invalid_argument(fmt::format(
        "PlannedSpeed: speeds must be finite and not negative, got {} m/s, {} m/s², target {} m/s",
        plan.speed_mps, plan.acceleration_mps2, plan.target_mps));
  }
}

}  // namespace

PlannedSpeed::PlannedSpeed(const SpeedPlan& plan)
    : start_squared_(plan.speed_mps * plan.speed_mps),
      acceleration_mps2_(plan.acceleration_mps2),
      target_squared_(plan.target_mps * plan.target_mps),
      fade_from_m_(std::numeric_limits<double>::infinity()) {
  check(plan);
  const double missing = target_squared_ - start_squared_;
  if (missing * acceleration_mps2_ <= 0.0) return;          // away from the target, or none to go
  const double slope = 2.0 * std::abs(acceleration_mps2_);  // |dw/dl| of the first phase
  // The fade begins where its own slope, missing/λ, has come down to the first phase's.
  fade_length_m_ =
      std::min(std::max(plan.target_mps * kFadeTime_s, kLeastFade_m), std::abs(missing) / slope);
  fade_from_m_ = std::abs(missing) / slope - fade_length_m_;
}

PlannedSpeed::State PlannedSpeed::at(double distance_m) const {
  if (distance_m <= fade_from_m_) {
    const double squared = start_squared_ + 2.0 * acceleration_mps2_ * distance_m;
    if (squared <= 0.0) return {0.0, 0.0, 0.0};
    return {std::sqrt(squared), acceleration_mps2_, 0.0};
  }
  const double left = std::exp(-(distance_m - fade_from_m_) / fade_length_m_);
  const double missing = 2.0 * acceleration_mps2_ * fade_length_m_ * left;
  const double speed_mps = std::sqrt(std::max(target_squared_ - missing, 0.0));
  const double acceleration_mps2 = acceleration_mps2_ * left;
  return {speed_mps, acceleration_mps2, -speed_mps * acceleration_mps2 / fade_length_m_};
}

}  // namespace roadbed::planning
