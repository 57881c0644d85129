#include "roadbed/control/lower_controller.h"

#include <fmt/format.h>

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

}  // namespace roadbed::control
