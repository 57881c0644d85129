#pragma once

#include "roadbed/map/lanelet2/write/lanelet_map.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Whether a lane of another format has a place in an Autoware map: where vehicles and bicycles
/// are, shoulders of roads, and sidewalks that lie along a road. Rails, and walkways and shoulders
/// of their own, have none.
bool has_place_in_autoware(const RoadMap& road_map, const Lane& lane);

/// What Autoware asks of lanelets by themselves and of the lines between them: its subtypes,
/// `location`, `one_way` and participants said; `lane_change` of lines between roads; road borders
/// beside shoulders; no line that vehicles and people on foot have in common.
/// @param road_map  that the lanelets are of.
void add_lane_tags(const RoadMap& road_map, LaneletMap& made);

}  // namespace roadbed::map::lanelet2
