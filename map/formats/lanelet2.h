#pragma once

#include "roadbed/map/formats/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::lanelet2 {

/// Whether the root element is that of an OpenStreetMap file, which holds Lanelet2 maps.
bool is_lanelet2(std::string_view root_element);

/// Everything of a Lanelet2 map that a RoadMap holds; its lines are kept as they are, whatever the
/// chord error asked for.
/// @throws InputError with the place in the file if it is unusable.
RoadMapParts read(const XmlDocument& xml);

}  // namespace roadbed::map::lanelet2
