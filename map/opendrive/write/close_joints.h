#pragma once

#include <vector>

#include "roadbed/map/opendrive/write/end_roles.h"
#include "roadbed/map/opendrive/write/placed_road.h"

namespace roadbed::map::opendrive {

/// Lets the borders of lanes that lead into each other meet, where roads share the line across
/// their ends but the map's borders leave a gap there, or differ about where they go on: those of
/// the road before a fork stay, the others are led to them over a few gaps' length.
void close_joints(const RoadMap& road_map, const RoadPlan& plan, std::vector<PlacedRoad>& placed);

}  // namespace roadbed::map::opendrive
