#pragma once

#include <vector>

#include "roadbed/map/opendrive/write/end_roles.h"
#include "roadbed/map/opendrive/write/placed_road.h"

namespace roadbed::map::opendrive {

/// How far from each other the borders of lanes that lead into each other end, in sum, on the line
/// across an end that their roads share. None of roads of the map, which have their own ends.
double joint_gap_m(const RoadPlan& plan, const EndJoints::value_type& joint,
                   const std::vector<PlacedRoad>& placed);

/// Lets the borders of lanes that lead into each other meet, where roads share the line across
/// their ends but the map's borders leave a gap there, or differ about where they go on: those of
/// the road before a fork stay, the others are led to them over a few gaps' length.
void close_joints(const RoadMap& road_map, const RoadPlan& plan, std::vector<PlacedRoad>& placed);

}  // namespace roadbed::map::opendrive
