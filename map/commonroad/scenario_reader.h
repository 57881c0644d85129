#pragma once

#include <string>

#include "roadbed/map/commonroad/scenario.h"

namespace roadbed::map::commonroad {

/// Obstacles and planning problems of a CommonRoad file (XML formats 2018b and 2020a).
/// @param name  stands for the file in messages.
/// @throws InputError with the place in the file if one of them is unusable.
Scenario parse_scenario(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::commonroad
