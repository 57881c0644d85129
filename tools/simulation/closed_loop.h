#pragma once

#include <functional>

#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// Bounds of the loop; the scenario's own options come on top.
struct LoopOptions {
  double goal_tolerance_m = 1.0;  ///< the vehicle stops this near to the goal's station, or nearer
  planning::PilotOptions pilot = {};
  std::function<void(double cycle_ms)> on_cycle = {};  ///< wall clock of each planning cycle
};

/// Drives a scenario: plans every 0.1 s, controls every 0.01 s, until the goal is reached, an
/// obstacle is touched, or the time is up. Deterministic: same scenario, same drive.
/// @param world  the motions of its drivers become what they did.
Drive drive(const Scenario& scenario, World& world, const LoopOptions& options = {});

}  // namespace roadbed::tools::simulation
