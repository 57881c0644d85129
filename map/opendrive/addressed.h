#pragma once

#include <vector>

#include "roadbed/map/opendrive/build_lanes.h"

namespace roadbed::map::opendrive {

/// Drivable lanes of a road at s that something there speaks to: those that <validity> names (all
/// if it names none) and that drive the way of `orientation`. Where the file names lanes and none
/// of them drives that way, those that it names: some tools write the orientation the other way
/// round.
std::vector<LaneId> addressed_lanes(const RoadRecord& road, std::size_t road_index,
                                    const BuiltLanes& built, double s_m, char orientation,
                                    const LaneRanges& ranges);

}  // namespace roadbed::map::opendrive
