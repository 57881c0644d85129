#pragma once

#include <string>

#include "roadbed/tools/simulation/common_road_world.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline simulation {

/// A drive as a CommonRoad solution (KS model, vehicle 2, cost function SM1): the states of the
/// vehicle's centre at the scenario's time steps.
std::string solution_xml(const CommonRoadDrive& problem, const Drive& drive);

}  // namespace roadbed::tools::simulation
