#pragma once

#include <vector>

#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/opendrive/build_lanes.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// How the lanes connect: along roads, across road ends, through junctions, and side by side.
/// Links that name what is not there are remarked and left out.
std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks);

}  // namespace roadbed::map::opendrive
