#pragma once

#include <vector>

#include "roadbed/map/formats/open_drive_document.h"
#include "roadbed/map/formats/open_drive_lanes.h"
#include "roadbed/map/lane_graph.h"

namespace roadbed::map::open_drive {

/// How the lanes connect: along roads, across road ends, through junctions, and side by side.
/// Links that name what is not there are remarked and left out.
std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportRemark>& remarks);

}  // namespace roadbed::map::open_drive
