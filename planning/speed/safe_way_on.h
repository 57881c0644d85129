#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/planning/speed/speed_question.h"

namespace roadbed::planning::inline speed {

/// What keeps a drive from going on safely after its last state, as an index in the world or
/// StInterval::kNoObstacle; none: braking at `braking_mps2` from then on, after the actuator's lag,
/// the vehicle comes to rest behind whoever is ahead on its path, who brakes as hard (the rule of
/// Shalev-Shwartz et al. 2017, "On a Formal Model of Safe and Scalable Self-driving Cars", def. 1),
/// before whoever comes the other way has come there, and before `end_m`.
/// @param last     its `t_s` is a time of the graph; who is there moves on as over the 0.3 s
/// before.
/// @param ignored  per obstacle: it is not looked at; none if empty.
/// O(N) in the parts of two times.
std::optional<std::size_t> who_bars_way_on(
    const SpeedState& last, const StGraph& occupancy, double end_m,
    const std::vector<bool>& ignored = {},
    double braking_mps2 = geometry::kLongitudinal.max_braking_mps2);

}  // namespace roadbed::planning::speed
