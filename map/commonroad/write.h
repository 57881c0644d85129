#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::commonroad {

/// The road network as a CommonRoad file (XML format 2020a), in source coordinates, with elevation
/// where the map has any: lanelets with their links, neighbours, markings, types and users; stop
/// lines; signs, among them one per speed limit; lights; intersections.
///
/// Ids are the source's where they are whole numbers, else counted from 1. A lane has one speed
/// limit and one marking a side there: the least limit, and the marking along most of the lane.
/// Signs that speak to no lane and lanes of type none cannot be said in CommonRoad and are left
/// out. Where the map names no scenario, its country is that of its signs.
std::string write_common_road(const RoadMap& road_map);

/// What such a file does not hold of the map, and how many of it.
std::vector<std::pair<std::string, std::size_t>> lost_in_common_road(const RoadMap& road_map);

}  // namespace roadbed::map::commonroad
