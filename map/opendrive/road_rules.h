#pragma once

#include <vector>

#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/stretch.h"

namespace roadbed::map::opendrive {

/// A lane's speed limit by road station: its own where it has one, else that of the road.
std::vector<Stretch<std::optional<double>>> speed_stretches(const RoadRecord& road,
                                                            const LaneRecord& lane, double from_s_m,
                                                            double to_s_m);

/// Who may use all of a lane: what its type says, narrowed or widened by its <access> records. At
/// one station "allow" lets in those named and nobody else, then "deny" keeps those named out.
Participants participants_along(const LaneRecord& lane);

/// The <access> records in words, by road station, "0 deny truck, 50 allow bus": they may name what
/// is no road user (autonomousTraffic, delivery) or change along the lane.
std::string access_in_words(const LaneRecord& lane);

}  // namespace roadbed::map::opendrive
