#pragma once

#include <vector>

#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline simulation {

/// What is worth telling of a cycle after the one before it: nothing feasible, an emergency,
/// another lead, …
/// @param last  none before the first cycle.
std::vector<DriveEvent> events_of(const DriveCycle& cycle, const DriveCycle* last);

}  // namespace roadbed::tools
