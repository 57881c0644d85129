#pragma once

#include <string>

#include "roadbed/map/lane_table/mapping.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lane_table {

/// Lanes of someone's own, from GeoJSON or a GeoPackage: each is drawn as a centreline with a
/// width, as two borders, or as a polygon with a direction; the columns that the mapping names say
/// the rest, and all are kept as attributes. Lanes side by side, whose facing borders run within
/// half a metre of each other in the same direction, are neighbours that may be changed between.
///
/// Rows that make no lane are remarked and left out.
/// @throws InputError if the file is unusable, lacks a column that the mapping names, or has no
/// lane.
RoadMapParts read(std::string bytes, const std::string& name, const Mapping& mapping);

}  // namespace roadbed::map::lane_table
