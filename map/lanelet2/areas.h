#pragma once

#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Multipolygons as areas: their rings put together from ways that share end nodes. One whose rings
/// do not close is left out and remarked.
void add_areas(Document& document, RoadMapParts& parts);

/// Closed lines (`area=yes`) as objects with an outline: parking lots, intersection areas.
void add_objects(Document& document, RoadMapParts& parts);

}  // namespace roadbed::map::lanelet2
