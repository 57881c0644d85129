#pragma once

#include <optional>

#include "roadbed/planning/behaviour/lead.h"

namespace roadbed::planning::inline behaviour {

/// Deceleration that the safety layer demands beyond what the cruise control may ask for.
struct SafetyOptions {
  double cruise_limit_mps2 = 0.25 * 9.81;  ///< up to here the cruise control brakes itself
  double most_mps2 = 8.0;                  ///< the vehicle's limit
  double standoff_m = 1.0;                 ///< gap to come to rest at
  double reaction_s = 0.45;                ///< the actuator's lag, driven before it bites
};

/// Deceleration [m/s²] that stops the closing in time, if the cruise control's authority cannot:
/// c² / (2 (gap − standoff − c · reaction)), c the closing speed. None: no need.
std::optional<double> emergency_deceleration_mps2(double speed_mps, const Lead& lead,
                                                  const SafetyOptions& options = {});

/// Deceleration that stops within a distance: v² / 2 d, at most the vehicle's limit. None: it
/// stands.
std::optional<double> emergency_stop_mps2(double speed_mps, double distance_m,
                                          const SafetyOptions& options = {});

}  // namespace roadbed::planning::behaviour
