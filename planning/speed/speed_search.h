#pragma once

#include "roadbed/planning/speed/speed_question.h"

namespace roadbed::planning::inline speed {

/// Least-cost drive along a path among everything that moves: a search over the s–t graph, where
/// the desired acceleration is chosen anew a few times up to the horizon and reaches the vehicle
/// through the actuator, a = K/(T s + 1) u, exactly. Of states of one time that go on
/// nearly alike the cheapest is kept. Cost counts the speed that is missing, commands
/// and their changes, gaps to what is ahead and behind, and a goal that is missed.
SpeedSearchAnswer search_speed(const SpeedSearchQuestion& question,
                               const SpeedSearchOptions& options);

}  // namespace roadbed::planning::speed
