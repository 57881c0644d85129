#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline behaviour {

/// A stretch of a reference line beside which the lane of oncoming traffic may be used:
/// the marking between may be crossed there.
struct OncomingLaneSegment {
  double from_s_m = 0.0, to_s_m = 0.0;
  double side = 1.0;        ///< of that lane: 1 left, −1 right
  double own_edge_m = 0.0;  ///< least distance from the line to that lane
  double limit_mps = 0.0;   ///< greatest speed that is allowed there
};

/// All of a route, by station; stretches of lanes that follow on one another are one. Where a lane
/// of the own direction lies between there is none. O(legs + length / 5 m).
std::vector<OncomingLaneSegment> oncoming_lane_segments(const map::RoadMap& road_map,
                                                        const Route& route,
                                                        const ReferenceLine& line);

}  // namespace roadbed::planning::behaviour
