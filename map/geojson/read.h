#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::geojson {

/// Whether bytes may be GeoJSON: a JSON object.
bool is_geojson(std::string_view bytes);

/// Road-surface polygons without lanes (RFC 7946): each Polygon and MultiPolygon is an area that
/// vehicles may be on, its properties are kept as attributes. Other geometries are counted.
///
/// Positions are longitude and latitude unless the member `crs` of GeoJSON 2008 names another
/// system, or is null: then they are metres as they stand. Longitude and latitude are projected to
/// the UTM zone of the first point, all of them.
///
/// A polygon whose rings are no region (crossing edges, holes outside or over each other) is left
/// out with a remark that names the ring; a file without a usable one is refused.
/// @throws InputError with the place in the file if it is unusable.
RoadMapParts read(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::geojson
