#pragma once

#include <memory>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/behaviour/driving_task.h"
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

}  // namespace roadbed::tools::simulation
