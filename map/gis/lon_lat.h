#pragma once

#include <Eigen/Core>
#include <span>

#include "roadbed/map/model/road_map.h"

// Between a map's coordinates and longitude (x) and latitude (y) in degrees, WGS 84, in place; the
// header offset of OpenDRIVE counts. There and back moves a point by less than 1 µm.

namespace roadbed::map::inline gis {

/// @throws InputError if the map names no coordinate system, and as map::to_lon_lat does.
void source_to_lon_lat(const RoadMap& road_map, std::span<Eigen::Vector2d> points);

/// Its inverse. Throws as it does, and for a place that the system does not reach.
void lon_lat_to_source(const RoadMap& road_map, std::span<Eigen::Vector2d> points);

}  // namespace roadbed::map::gis
