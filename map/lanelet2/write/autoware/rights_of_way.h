#pragma once

#include "roadbed/map/lanelet2/write/autoware/written_map.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// For each road that turns at traffic lights and names no right of way, one that says who yields.
/// Without lights nothing is added: who goes first there is the source's to say.
void add_rights_of_way(const WrittenMap& written, LaneletMap& made);

}  // namespace roadbed::map::lanelet2
