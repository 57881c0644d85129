#include "roadbed/control/lower_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::control {

double actuate(double acceleration_mps2, double desired_mps2, double step_s,
               const ActuatorOptions& options) {
  if (!(options.lag_s > 0.0) || !(step_s >= 0.0)) {
    throw std::invalid_argument(fmt::format(
        "actuate: the lag must be positive and the step not negative, got {} s and {} s",
        options.lag_s, step_s));
  }
  const double settled = options.gain * desired_mps2;
  return settled + (acceleration_mps2 - settled) * std::exp(-step_s / options.lag_s);
}

double resistance_N(double speed_mps, double grade_rad, const DriveTrain& train) {
  const double weight_N = 9.81 * train.mass_kg;
  return 0.5 * train.air_density_kgpm3 * train.drag_area_m2 * speed_mps * speed_mps +
         weight_N * (train.rolling_resistance * std::cos(grade_rad) + std::sin(grade_rad));
}

Pedals PedalController::update(double desired_mps2, double speed_mps, double grade_rad) {
  const double force_N = train_.mass_kg * desired_mps2 + resistance_N(speed_mps, grade_rad, train_);
  if (force_N > band_N_) brakes_ = false;
  if (force_N < -band_N_) brakes_ = true;
  if (brakes_) return {.brake = std::clamp(-force_N / train_.full_brake_N, 0.0, 1.0)};
  return {.throttle = std::clamp(force_N / train_.full_throttle_N, 0.0, 1.0)};
}

double acceleration_mps2(const DrivenState& state, double grade_rad, const DriveTrain& train) {
  return (state.force_N - resistance_N(state.speed_mps, grade_rad, train)) / train.mass_kg;
}

DrivenState drive(const DrivenState& state, const Pedals& pedals, double grade_rad, double step_s,
                  const DriveTrain& train) {
  const double wanted_N =
      pedals.throttle * train.full_throttle_N - pedals.brake * train.full_brake_N;
  const double speed_mps =
      std::max(0.0, state.speed_mps + step_s * acceleration_mps2(state, grade_rad, train));
  return {.speed_mps = speed_mps,
          .force_N = actuate(state.force_N, wanted_N, step_s, {.lag_s = train.lag_s})};
}

}  // namespace roadbed::control
