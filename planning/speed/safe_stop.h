#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/obstacles/reachable_set.h"
#include "roadbed/planning/speed/path_profile.h"

namespace roadbed::planning::inline speed {

/// Somebody who may be in the way, and where.
struct MayBeMet {
  std::size_t obstacle = 0;
  ReachableSet set;  ///< from now on
};

/// A vehicle on its path, and those around it.
struct StopQuestion {
  const PathProfile& profile;
  double speed_mps = 0.0, acceleration_mps2 = 0.0;
  std::span<const MayBeMet> others = {};
};

/// Time until the vehicle stands that holds a command for a cycle and then brakes at 8 m/s², behind
/// its actuator's lag [s].
double stop_s(const StopQuestion& question, double command_mps2);

/// Whom the vehicle may touch before it stands so, as an index in `others`; none: nobody, whatever
/// they do within their bounds [Pek, Manzinger, Koschi, Althoff 2020, "Using Online Verification to
/// Prevent Autonomous Vehicles from Causing Accidents", doi:10.1038/s42256-020-0225-y]. Who touches
/// it when it stands is not looked at. O(others × stopping time).
std::optional<std::size_t> who_may_bar_stop(const StopQuestion& question, double command_mps2);

/// A command after which such a stop is free.
struct SafeCommand {
  double command_mps2 = 0.0;
  std::optional<std::size_t> who = {};  ///< keeps it from being more; index in `others`
  bool is_safe = true;                  ///< else none is, down to −¼ g
};

/// The greatest of a few, from what is wanted down to −¼ g. Where there is none: −¼ g, if braking
/// at once as hard as it can would still do, else no acceleration; nor more than is wanted.
SafeCommand safe_command(const StopQuestion& question, double wanted_mps2);

}  // namespace roadbed::planning::speed
