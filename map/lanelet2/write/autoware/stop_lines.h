#pragma once

#include "roadbed/map/lanelet2/write/autoware/written_map.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// A road_marking element for each stop line that none names, where it lies on a road: that road
/// names it.
void add_road_markings(const WrittenMap& written, LaneletMap& made);

}  // namespace roadbed::map::lanelet2
