#pragma once

#include <filesystem>
#include <string>

#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// A CommonRoad planning problem, ready to be driven.
struct CommonRoadDrive {
  Scenario scenario;  ///< options, vehicle and duration; its map is the file itself
  World world;        ///< obstacles as recorded: what they will do is known
  std::string benchmark_id, version, problem_id;
  long start_step = 0;  ///< time step of second 0
};

/// Whether a file is a CommonRoad scenario, by its first bytes.
bool is_common_road(const std::filesystem::path& file);

/// Reads the first planning problem of a CommonRoad file: time 0 is that of its initial state. The
/// vehicle is CommonRoad's vehicle 2 and nothing is left to chance, unless `changes` say otherwise;
/// the vehicle's centre is where the file has it. The route leads to the goal's place; where the
/// goal asks for none, straight on from the start.
/// @throws InputError if the file is unusable, has no planning problem, the start or the goal is
///         off the road, no route leads to the goal, or an obstacle touches the ego at the start.
CommonRoadDrive read_common_road_drive(const std::filesystem::path& file,
                                       const ScenarioChanges& changes = {},
                                       const Inputs& inputs = Inputs());

}  // namespace roadbed::tools::simulation
