#pragma once

#include <span>
#include <string>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// The least time between two poses of an obstacle.
inline constexpr double kLeastObstacleStep_s = 1e-6;

/// Refuses obstacles whose ways take endless work: whoever looks at one that moves looks along its
/// way, and a few rows can be worlds apart. All ways together may be 200 km, and 20 m more for
/// each pose; poses are kLeastObstacleStep_s apart at least. O(poses).
/// @param file  stands for where they are from.
/// @throws InputError with the obstacle of the longest step.
template <Frame kFrame>
void refuse_endless_ways(std::span<const ObstacleIn<kFrame>> obstacles, const std::string& file);

}  // namespace roadbed::planning::obstacles
