#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/task/driving_task.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/traffic_flow.h"

namespace roadbed::tools::inline simulation {

/// What a scenario means: its files loaded, its places found, its obstacles set in motion.
struct World : planning::DrivingTask {
  std::shared_ptr<const map::OccupancyMap> occupancy = {};  ///< none where there is no file of it
  std::vector<LaneDriver> drivers = {};  ///< of the obstacles that follow who is ahead
};

/// @throws InputError if a file is unusable, a place is not on the map, there is no route to the
///         goal, or an obstacle touches the ego at the start; it names the place in the scenario.
World make_world(const Scenario& scenario, const Inputs& inputs = Inputs());

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
