#pragma once

#include "roadbed/control/cruise_design.h"

namespace roadbed::control {

/// Largest gain from a lead to its follower, over frequency.
struct StringGain {
  double gain = 0.0;  ///< 1 or less: a disturbance does not grow down a platoon
  double at_radps = 0.0;
};

/// |a_f / a_p| of the sampled closed loop u = −K x, without filter, delay and saturation, from
/// 0.001 rad/s to the Nyquist frequency.
StringGain string_gain(const CruiseDesign& design, double step_s);

/// |v_f / v_p| of the sampled loop as it is run, from 0.01 to 1 Hz: u = −K x̂ from the Kalman
/// filter, which does not know the lead's acceleration, and reaches the actuator `delay_steps`
/// late. Without saturation.
/// @throws std::invalid_argument if the delay is negative.
StringGain loop_string_gain(const CruiseDesign& design, double step_s, int delay_steps);

}  // namespace roadbed::control
