#pragma once

#include "roadbed/map/lanelet2/write/autoware/written_map.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// Intersection areas, and of the roads in them the turn directions and virtual borders.
///
///        ┊   ┊           An intersection is a crossing that the map names, or where there are
///        none,
///     ●──●   ●──●        roads that cross and those in conflict with them. Its area is the hull
///     ┈┈┈┈┈┈┈┈┈┈┈        of their corners ●; a road that does not lie in it is not of it.
///     ●──●   ●──●
///        ┊   ┊
///
/// A map that has such areas keeps them, gets no others, and roads in them say so.
void add_intersections(const RoadMap& road_map, const WrittenMap& written, LaneletMap& made);

}  // namespace roadbed::map::lanelet2
