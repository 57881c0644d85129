#pragma once

#include <string>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Everything of a Lanelet2 map that a RoadMap holds; its lines are kept as they are, whatever the
/// chord error asked for.
/// @param bytes  UTF-8.
/// @throws InputError with the place in the file if it is unusable.
RoadMapParts read(const std::string& bytes, const std::string& file);

}  // namespace roadbed::map::lanelet2
