#pragma once

#include <optional>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline speed {

/// How an acceleration that is asked for reaches the vehicle: a = 1 / (lag s + 1) u, |u| bounded.
inline constexpr double kActuatorLag_s = geometry::kLongitudinal.actuator_lag_s;
inline constexpr double kMostCommand_mps2 = geometry::kLongitudinal.max_command_mps2;

/// A cruise control behind sensors: what is known of the lead is what it measures and filters.
class SpeedController {
 public:
  virtual ~SpeedController() = default;

  /// The lead as it is known at this time; to be asked once a cycle, before acceleration_mps2().
  /// None: nobody is ahead, or was not measured for too long.
  /// @param ahead  to be measured; none: no vehicle is ahead.
  virtual std::optional<Lead> observe(const VehicleState& measured,
                                      const std::optional<Lead>& ahead, double t_s) = 0;

  /// Desired acceleration, within ±kMostCommand_mps2: to the set speed, or behind the lead.
  virtual double acceleration_mps2(const VehicleState& measured, const SpeedTarget& set) = 0;

  /// What the actuator was asked for in the end.
  virtual void sent(double acceleration_mps2) = 0;
};

}  // namespace roadbed::planning::speed
