#pragma once

#include "roadbed/map/lanelet2/lanes.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Regulatory elements of every kind, with what they refer to; those nobody here knows are kept
/// like all others. Adds the signs, lights and stop lines that they name, and the limits of
/// speed_limit elements to their lanes.
void add_regulations(Document& document, BuiltLanes& built, RoadMapParts& parts);

}  // namespace roadbed::map::lanelet2
