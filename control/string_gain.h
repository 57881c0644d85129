#pragma once

#include "roadbed/control/cruise_design.h"

namespace roadbed::control {

/// Largest gain from a lead's acceleration to its follower's, over frequency.
struct StringGain {
  double gain = 0.0;  ///< 1 or less: a disturbance does not grow down a platoon
  double at_radps = 0.0;
};

/// |a_f / a_p| of the sampled closed loop u = −K x, without filter, delay and saturation, from
/// 0.001 rad/s to the Nyquist frequency.
StringGain string_gain(const CruiseDesign& design, double step_s);

}  // namespace roadbed::control
