#pragma once

#include "roadbed/map/lanelet2/build_map.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// A Lanelet2 file as it was read, with all ids, tags and members, to be written again: what is in
/// the model of a map and what is not. Left out are elements that the reader leaves out (without a
/// place, of an id that came before) and members that are not there.
/// @param built  lanes of the document, by LaneId.
LaneletMap lanelet_map_of(const Document& document, const BuiltLanes& built);

}  // namespace roadbed::map::lanelet2
