#pragma once

#include <string>

#include "roadbed/map/road_map.h"

namespace roadbed::map {

/// The map as a GeoJSON feature collection, a feature per line of text: per lane its polygon
/// (`kind` "lane") and its centreline ("centreline", with elevation), then signals ("signal").
///
/// Coordinates are the source's raw ones in metres, which RFC 7946 allows only by prior agreement;
/// the member `crs` of the older GeoJSON 2008 names the system as the source does, and is null
/// where the source does not say. GDAL and QGIS understand both.
std::string write_geojson(const RoadMap& road_map);

}  // namespace roadbed::map
