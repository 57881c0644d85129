#pragma once

#include "roadbed/planning/speed/path_profile.h"

namespace roadbed::tests {

/// A path straight along the x axis, 200 m long, a sample every 0.5 m.
/// @param most_mps  that its bends allow.
planning::PathProfile straight_profile(double wanted_mps, double most_mps = 60.0);

}  // namespace roadbed::tests
