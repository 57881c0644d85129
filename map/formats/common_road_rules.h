#pragma once

#include <string>

#include "roadbed/map/formats/common_road_lanes.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::common_road {

/// Signs, lights, stop lines and intersections, added to the parts; speed limits are set on the
/// lanes that refer to such a sign (of several the least), lanes inside an intersection get its
/// junction. References to what is not there are remarked.
/// @param country  "DEU", or empty.
void add_rules(const XmlDocument& xml, const std::string& country, BuiltLanes& built,
               RoadMapParts& parts);

}  // namespace roadbed::map::common_road
