#pragma once

#include <string>

#include "roadbed/map/lanelet2/build_map.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Everything of a Lanelet2 map that a RoadMap holds; its lines are kept as they are, whatever the
/// chord error asked for.
/// @param threads  that may be used.
/// @throws InputError with the place in the file if it is unusable.
RoadMapParts read(std::string bytes, const std::string& file, int threads = 1);

/// The same of a document whose lanes are built.
RoadMapParts read(Document document, BuiltLanes built, int threads = 1);

}  // namespace roadbed::map::lanelet2
