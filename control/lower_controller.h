#pragma once

namespace roadbed::control {

/// Lower controller, actuator and vehicle together: a_f = K_L / (T_L s + 1) · a_des (paper eq. 25).
struct ActuatorOptions {
  double lag_s = 0.45;  ///< T_L
  double gain = 1.0;    ///< K_L
};

/// Acceleration after `step_s` of a constant desired acceleration, exact for any step.
/// @throws std::invalid_argument if the lag is not positive or the step is negative.
double actuate(double acceleration_mps2, double desired_mps2, double step_s,
               const ActuatorOptions& options = {});

}  // namespace roadbed::control
