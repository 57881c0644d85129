#pragma once

#include <vector>

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::tools::inline simulation {

/// Savitzky–Golay: the `derivative` of the polynomial of order `order` that fits a window of
/// equally spaced values best, at the window's middle; at both ends, of the polynomial of the first
/// and last window. A list shorter than the window is one window. As scipy's
/// savgol_filter(mode="interp"), whose windows of even length reach one value further ahead than
/// back.
/// @throws std::invalid_argument if the order is not less than the window, or negative.
std::vector<double> savitzky_golay(const std::vector<double>& values, double step_s, int window,
                                   int order, int derivative);

/// Extremes of a drive by which nuPlan judges comfort (ego_is_comfortable), of signals smoothed as
/// there: accelerations over 8 rows, jerks over 15, turning over 5.
struct Comfort {
  double least_longitudinal_mps2 = 0.0, most_longitudinal_mps2 = 0.0;
  double most_lateral_mps2 = 0.0;  ///< absolute, as all below
  double most_yaw_acceleration_radps2 = 0.0, most_yaw_rate_radps = 0.0;
  double most_longitudinal_jerk_mps3 = 0.0, most_jerk_mps3 = 0.0;

  /// Within nuPlan's seven bounds.
  bool is_comfortable() const;
};

/// @param drive  rows at equal steps, the last may be earlier.
Comfort comfort_of(const geometry::Trajectory& drive);

}  // namespace roadbed::tools::simulation
