#include "roadbed/planning/lateral/planned_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roadbed::planning::inline lateral {
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

void check(std::span<const SpeedSample> profile) {
  const auto refuse = [](std::size_t row, const char* rule) {
    throw std::invalid_argument(fmt::format("PlannedSpeed: row {} of the profile {}", row, rule));
  };
  if (profile.empty()) throw std::invalid_argument("PlannedSpeed: the profile is empty");
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const SpeedSample& sample = profile[i];
    const bool finite = std::isfinite(sample.distance_m) && std::isfinite(sample.speed_mps) &&
                        std::isfinite(sample.acceleration_mps2);
    if (!finite) refuse(i, "is not finite");
    if (sample.speed_mps < 0.0) refuse(i, "has a negative speed");
    if (i > 0 && !(sample.distance_m > profile[i - 1].distance_m)) {
      refuse(i, "is not further than the one before");
    }
  }
}

// w = v² and its derivatives by distance, cubic between two samples.
struct Squared {
  double w, slope, bend;
};

Squared between(const SpeedSample& a, const SpeedSample& b, double distance_m) {
  const double length = b.distance_m - a.distance_m, t = (distance_m - a.distance_m) / length;
  const double from = a.speed_mps * a.speed_mps, rise = b.speed_mps * b.speed_mps - from;
  const double slope_a = 2.0 * a.acceleration_mps2 * length;
  const double slope_b = 2.0 * b.acceleration_mps2 * length;
  const double c2 = 3.0 * rise - 2.0 * slope_a - slope_b, c3 = slope_a + slope_b - 2.0 * rise;
  return {from + t * (slope_a + t * (c2 + t * c3)),
          (slope_a + t * (2.0 * c2 + t * 3.0 * c3)) / length,
          (2.0 * c2 + t * 6.0 * c3) / (length * length)};
}

}  // namespace

PlannedSpeed::PlannedSpeed(std::span<const SpeedSample> profile)
    : profile_(profile.begin(), profile.end()) {
  check(profile);
}

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

PlannedSpeed::State PlannedSpeed::in_profile(double distance_m) const {
  if (distance_m < profile_.front().distance_m) return {profile_.front().speed_mps, 0.0, 0.0};
  const auto next = std::ranges::upper_bound(profile_, distance_m, {}, &SpeedSample::distance_m);
  if (next == profile_.end()) return {profile_.back().speed_mps, 0.0, 0.0};
  const Squared squared = between(*(next - 1), *next, distance_m);
  if (squared.w <= 0.0) return {0.0, 0.0, 0.0};
  const double speed_mps = std::sqrt(squared.w);
  return {speed_mps, 0.5 * squared.slope, 0.5 * speed_mps * squared.bend};
}

PlannedSpeed::State PlannedSpeed::at(double distance_m) const {
  if (!profile_.empty()) return in_profile(distance_m);
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

}  // namespace roadbed::planning::lateral
