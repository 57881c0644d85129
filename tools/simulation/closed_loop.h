#pragma once

#include <functional>

#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {

/// Bounds of the loop; the scenario's own options come on top.
struct LoopOptions {
  /// Beyond either, planning starts from the measured state instead of the last plan.
  double max_tracking_error_m = 0.3;
  double max_heading_error_rad = 0.15;
  double goal_tolerance_m = 1.0;  ///< the vehicle stops this near to the goal's station, or nearer
  /// Pilots know of other vehicles only what could be known at the time, not their true future.
  bool predicts = false;
  /// Each cycle keeps what became of its candidates; all of them are judged, which takes longer.
  bool keeps_candidates = false;
  std::function<void(double cycle_ms)> on_cycle = {};  ///< wall clock of each planning cycle
};

/// Greatest speeds along a line for the scenario's vehicle and options.
planning::SpeedCeiling ceiling_of(const Scenario& scenario, const planning::ReferenceLine& line);

/// Drives a scenario: plans every 0.1 s, controls every 0.01 s, until the goal is reached, an
/// obstacle is touched, or the time is up. Deterministic: same scenario, same drive.
/// @param world  the motions of its drivers become what they did.
Drive drive(const Scenario& scenario, World& world, const LoopOptions& options = {});

}  // namespace roadbed::tools
