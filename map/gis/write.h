#pragma once

#include <span>
#include <string>

#include "roadbed/map/gis/layers.h"

/// The files of geographic information systems, each in a source of its name.
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

/// Layers as a GeoPackage (OGC 12-128r18, version 1.3): a table per layer, and `layer_styles`, from
/// which QGIS takes its colours. Same layers, same bytes: dates that the format asks for are the
/// first of 1970.
/// @param crs  of the coordinates, empty if unknown: then the layers are in metres of an undefined
///             Cartesian system.
/// @throws InputError if PROJ cannot describe the system, see projection.h.
std::string write_geopackage(std::span<const Layer> layers, const std::string& crs);

/// A layer as FlatGeobuf (version 3), features in the order of a Hilbert curve, with its index, so
/// that a reader can ask for a box. Features of no place are left out: the format's index has no
/// word for them.
/// @param crs  of the coordinates; empty if unknown.
/// @throws InputError if PROJ cannot describe the system, see projection.h.
std::string write_flatgeobuf(const Layer& layer, const std::string& crs);

/// The lines of all lanes as CSV, a row per vertex, lanes in order of id, per lane left, right and
/// centre: `road,section,lane,type,line,s_m,x_m,y_m,z_m`. x and y are source coordinates; numbers
/// are the shortest that read back as the same double; fields are quoted as in RFC 4180.
///
/// Road areas without lanes follow as their centrelines ("area 1", …, type "other"), with borders
/// half the area's width to either side; s_m runs along the centreline, z is 0.
std::string write_csv(const RoadMap& road_map);

}  // namespace roadbed::map::gis
