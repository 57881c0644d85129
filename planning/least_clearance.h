#pragma once

// Private to planning.

#include <optional>
#include <string>

#include "roadbed/planning/probe.h"

namespace roadbed::planning {

/// The least distance over a drive, bracketed.
struct LeastClearance {
  double found_m = 0.0;   ///< attained at `at`
  double proven_m = 0.0;  ///< nowhere less; found − proven ≤ tolerance
  geometry::TrajectoryPoint at;
  std::optional<map::Box2> witness;  ///< none: nothing within the horizon
  std::string obstacle = {};         ///< the witness's id, if it moves
};

/// Best first in each thousand segments: the span that may hold the least distance is halved until
/// its motion bound closes the bracket. Distance as a function of time is Lipschitz with the motion
/// bound [Piyavskii 1972, doi:10.1016/0041-5553(72)90115-2].
LeastClearance find_least_clearance(const Probe& probe, double tolerance_m);

}  // namespace roadbed::planning
