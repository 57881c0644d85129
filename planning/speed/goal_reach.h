#pragma once

#include "roadbed/planning/speed/speed_search.h"

namespace roadbed::planning::inline speed {

/// Whether any speed could lead to one of a question's goals: where nobody is in the way all the
/// time up to then, and as fast as the strongest command allows, however it changes. False means
/// that the search finds nothing either; true, that it may. True also where no goal is asked for,
/// or none lies on this path: a later one may lead there.
bool may_reach_goal(const SpeedSearchQuestion& question, double most_mps2);

}  // namespace roadbed::planning::speed
