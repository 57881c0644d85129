#pragma once

#include <string>
#include <vector>

#include "roadbed/map/opendrive/write/road_network.h"
#include "roadbed/map/opendrive/write/road_plan.h"
#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// What of the lanes could not be said.
struct LaneLosses {
  std::size_t access = 0;     ///< lanes whose users 1.4 has no words for
  std::size_t direction = 0;  ///< lanes driven against their side, or both ways, in 1.4
};

/// The <lanes> of a part of a road.
std::string lanes_text(const RoadMap& road_map, const PlannedRoad& road, const RoadShape& shape,
                       const RoadPart& part, bool left_hand_traffic, int minor, LaneLosses& losses);

}  // namespace roadbed::map::opendrive
