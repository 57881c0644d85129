#pragma once

#include <vector>

#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/lanelet2/lanes.h"

namespace roadbed::map::lanelet2 {

/// Lane links as Lanelet2's routing graph has them, for all road users: a lane follows another if
/// it begins with the two nodes that the other one ends with and somebody may use both; lanes are
/// neighbours if they share a border way. Of several neighbours on one side, that of the same
/// direction and the same users comes first, then the one that comes first in the file. Where more
/// than 64 lanes meet, the rest is left out and remarked.
std::vector<LaneLinks> link_lanes(Document& document, const BuiltLanes& built);

}  // namespace roadbed::map::lanelet2
