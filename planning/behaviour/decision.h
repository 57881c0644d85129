#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/planning/behaviour/behaviour.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/right_of_way/hidden_walkers.h"
#include "roadbed/planning/right_of_way/right_of_way.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline behaviour {

/// What the set speed is chosen from, at one planning cycle.
struct SpeedQuestion {
  const SpeedCeiling& ceiling;
  double s_m = 0.0;       ///< station of the rear axle
  double goal_s_m = 0.0;  ///< to stop at
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  std::optional<Lead> lead;
  std::string lead_name;            ///< for the reason
  std::optional<Lead> let_in = {};  ///< who is not in the lane yet, and is let in
  std::string let_in_reason = {};
  bool follows = false;  ///< in the cycle before: who follows is not said to cruise for a moment
  /// Set if the planner found nothing: the last path is still good for so far; stop on it.
  std::optional<double> path_left_m;
  std::optional<StopConstraint> halt = {};  ///< where a rule of the road asks to wait
  std::optional<double> seen_ahead_m =
      {};  ///< of the road, as far as is to be kept free; none: all
  std::span<const HiddenWalker> walkers = {};  ///< who may step out
  std::optional<double> creep_mps = {};  ///< not faster, as somebody may come from hidden space
};

/// The set speed, and what it is due to.
struct SpeedAnswer {
  SpeedTarget set;
  Behaviour behaviour = Behaviour::cruise;
  std::string reason;
  bool hold = false;  ///< the vehicle has come to rest on purpose: keep the brake on
};

struct DecisionOptions {
  double deceleration_mps2 = 1.5;
  double most_deceleration_mps2 = 2.0;  ///< to stop on a path that ends
  double headway_s = geometry::kLongitudinal.headway_s;
  double standstill_gap_m = geometry::kLongitudinal.standstill_gap_m;
  double closing_s = 2.7;  ///< the cruise control closes a gap e at e / this [m/s]
  /// The actuator's lag: deceleration is asked for this much ahead.
  double preview_s = geometry::kLongitudinal.actuator_lag_s;
  double acceleration_mps2 = 1.5;  ///< on a free road, by the cruise control's gain
};

/// What was driven since a lead was seen, and by how much the gap to it has closed.
struct Approached {
  double driven_m = 0.0, closed_m = 0.0;
};

/// Speed at which to close up to a lead, to the gap that the cruise control then keeps: in the
/// lead's frame the approach is a stop, at the gap that belongs to the lead's speed; behind a lead
/// that brakes it is one in the road's frame, where the lead will stand.
SpeedTarget approach_speed(const Lead& lead, const Approached& since,
                           const DecisionOptions& options);

/// The least of: the ceiling, the stop at the goal, the halt that a rule asks for, the stop on a
/// path that ends, and the approaches to the lead and to who is let in, which close up at a
/// comfortable deceleration to the gap that the cruise control then keeps.
SpeedAnswer choose_speed(const SpeedQuestion& question, const DecisionOptions& options);

}  // namespace roadbed::planning::behaviour
