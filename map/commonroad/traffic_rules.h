#pragma once

#include <string>

#include "roadbed/map/commonroad/lanes.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::commonroad {

/// Signs, lights, stop lines and intersections, added to the parts; speed limits are set on the
/// lanes that refer to such a sign (of several the least), lanes inside an intersection get its
/// junction. References to what is not there are remarked.
/// @param country  "DEU", or empty.
void add_rules(const XmlDocument& xml, const std::string& country, BuiltLanes& built,
               RoadMapParts& parts);

}  // namespace roadbed::map::commonroad
