#pragma once

#include <span>
#include <string>

#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

/// What of a GeoJSON file is not in its features.
struct GeojsonHead {
  bool lon_lat = false;       ///< else metres in the source's raw coordinates
  std::string source_format;  ///< "OpenDRIVE 1.4"
  std::string source_crs;     ///< as the source names it, may be empty
};

/// Layers as one GeoJSON feature collection, a feature per line of text; the member `kind` of its
/// properties says which layer it is of ("lane", "centreline", …).
///
/// In longitude and latitude it is as RFC 7946 asks, to 1e-9 degrees (0.1 mm). Raw metres, which
/// RFC 7946 allows only by prior agreement, are written where no coordinate system is known: then
/// the member `crs` of the older GeoJSON 2008 is there and null, which GDAL and QGIS understand.
std::string write_geojson(std::span<const Layer> layers, const GeojsonHead& head);

}  // namespace roadbed::map::gis
