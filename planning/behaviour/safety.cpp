#include "roadbed/planning/behaviour/safety.h"

#include <algorithm>

namespace roadbed::planning::inline behaviour {

std::optional<double> emergency_deceleration_mps2(double speed_mps, const Lead& lead,
                                                  const SafetyOptions& options) {
  const double closing = speed_mps - lead.speed_mps;
  if (closing <= 0.0 || speed_mps <= 0.0) return std::nullopt;
  constexpr double kLeast_m = 0.1;
  const double free_m = lead.gap_m - options.standoff_m - closing * options.reaction_s;
  const double needed = closing * closing / (2.0 * std::max(kLeast_m, free_m));
  if (needed <= options.cruise_limit_mps2) return std::nullopt;
  return std::min(needed, options.most_mps2);
}

std::optional<double> emergency_stop_mps2(double speed_mps, double distance_m,
                                          const SafetyOptions& options) {
  constexpr double kLeast_m = 0.1;
  if (speed_mps <= 0.0) return std::nullopt;
  const double needed = 0.5 * speed_mps * speed_mps / std::max(kLeast_m, distance_m);
  return std::min(needed, options.most_mps2);
}

}  // namespace roadbed::planning::behaviour
