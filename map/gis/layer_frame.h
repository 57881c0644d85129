#pragma once

#include <string>
#include <vector>

#include "roadbed/map/gis/layer.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline gis {

/// Layers from `in_map` to the source's raw coordinates [m].
void to_source(const RoadMap& road_map, std::vector<Layer>& layers);

/// Layers from the source's raw coordinates to those of its coordinate reference system: turned and
/// moved by the map's offset (OpenDRIVE's header), heights moved.
void source_to_crs(const RoadMap& road_map, std::vector<Layer>& layers);

/// Layers from coordinates of a system to longitude and latitude (degrees, WGS 84), heights as
/// they stand. @throws InputError as `to_lon_lat` does.
void to_lon_lat(const std::string& crs, std::vector<Layer>& layers);

}  // namespace roadbed::map::gis
