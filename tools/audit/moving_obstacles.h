#pragma once

#include <filesystem>
#include <vector>

#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline audit {

/// Obstacles over time, in source coordinates: of a scenario (`.json`, or CommonRoad `.xml`, see
/// `recorded_boxes`), or boxes with time stamps (`.csv`).
/// @throws InputError if the file, or one that it names, is unusable.
std::vector<planning::ObstacleInSource> read_moving_obstacles(const std::filesystem::path& file,
                                                              const Inputs& inputs);

}  // namespace roadbed::tools::audit
