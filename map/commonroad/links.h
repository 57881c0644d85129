#pragma once

#include <vector>

#include "roadbed/map/commonroad/lanes.h"
#include "roadbed/map/elements/lane_graph.h"

namespace roadbed::map::commonroad {

/// How the lanes connect: `successor`, `predecessor`, `adjacentLeft`, `adjacentRight`.
///
/// A link of lanes that do not touch, or of which only one of the two speaks, is remarked; the
/// first is left out, the second holds for both. Lanes may be changed where the line marking can be
/// crossed, without one between lanes of the same direction, and only where the two borders run
/// within 1 m of each other.
std::vector<LaneLinks> link_lanes(const XmlDocument& xml, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks);

}  // namespace roadbed::map::commonroad
