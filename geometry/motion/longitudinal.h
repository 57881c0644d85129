#pragma once

#include <algorithm>

namespace roadbed::geometry::inline motion {

/// How a vehicle drives and follows along the road [paper section 3.3]. Planning and control do not
/// know each other, but have to mean the same vehicle: both take their defaults from here.
struct Longitudinal {
  double headway_s = 1.5;                 ///< τ_h
  double standstill_gap_m = 5.0;          ///< d_0
  double actuator_lag_s = 0.45;           ///< T_L, in a = K_L / (T_L s + 1) u (paper eq. 25)
  double actuator_gain = 1.0;             ///< K_L
  double max_command_mps2 = 0.25 * 9.81;  ///< of |u|; paper: ¼ g
  double max_braking_mps2 = 8.0;          ///< on a dry road, where nothing else is left
  double max_jerk_mps3 = 4.0;  ///< of u, as the actuator turns it; nuPlan's bound is 4.13
  double cycle_s = 0.1;        ///< T: a command u is held for so long
};

inline constexpr Longitudinal kLongitudinal{};

/// Way in a time of who speeds up to a speed at most; who is faster goes on as fast.
constexpr double speeding_up_m(double speed_mps, double gain_mps2, double most_mps,
                               double after_s) {
  const double gains_s = std::min(after_s, std::max(0.0, most_mps - speed_mps) / gain_mps2);
  const double gained_mps = gain_mps2 * gains_s;
  return speed_mps * after_s + 0.5 * gained_mps * gains_s + gained_mps * (after_s - gains_s);
}

}  // namespace roadbed::geometry::motion
