#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::validation {

/// Every fault of a map, in order of rule and element. Never throws over a faulty map.
std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options = {});

}  // namespace roadbed::map::validation
