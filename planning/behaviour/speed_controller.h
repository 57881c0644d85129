#pragma once

#include <optional>

#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/behaviour/planned_path.h"
#include "roadbed/planning/reference/speed_ceiling.h"

namespace roadbed::planning::inline behaviour {

/// How an acceleration that is asked for reaches the vehicle: a = 1 / (lag s + 1) u, |u| bounded.
inline constexpr double kActuatorLag_s = 0.45;
inline constexpr double kMostCommand_mps2 = 0.25 * 9.81;  // paper: ±0.25 g

/// Turns set speed and lead into the acceleration to ask for: a cruise control behind sensors.
class SpeedController {
 public:
  virtual ~SpeedController() = default;

  /// Whether a lead is measured at a time at all; to be asked once per time.
  virtual bool sees_lead(double t_s) = 0;

  struct Question {
    const VehicleState& measured;
    SpeedTarget set;
    std::optional<Lead> lead;  ///< true one, to be measured; none: no vehicle is ahead
    bool is_blind = false;     ///< there is a lead, but it is not measured now
  };

  /// Desired acceleration, within ±kMostCommand_mps2.
  virtual double acceleration_mps2(const Question& question) = 0;
};

}  // namespace roadbed::planning::behaviour
