#pragma once

// Private to planning.

#include <vector>

#include "roadbed/planning/audit.h"
#include "roadbed/planning/probe.h"

namespace roadbed::planning {

/// Where a drive is nearer to something than allowed, and where that cannot be told.
struct NearStretches {
  std::vector<Conflict> near;
  std::vector<Stretch> undecided;  ///< apart from `near`
};

/// Halves every span until it is proven clear of `clearance_m`, shown to be too near to within
/// `tolerance_m` of motion, or too short to go on (1 mm of motion): undecided. An overlap or touch
/// is always too near. Drives of over 40 km get a coarser tolerance, a millionth of their length.
/// @pre clearance_m is less than the field's horizon.
NearStretches find_near_stretches(const Probe& probe, double clearance_m, double tolerance_m);

}  // namespace roadbed::planning
