#pragma once

#include <string>

#include "roadbed/map/gis/layers.h"

/// What a GeoPackage holds of a layer besides its values.
namespace roadbed::map::inline gis {

/// A shape as a GeoPackage holds it: its header ("GP", flags, system, envelope), then well-known
/// binary (OGC 06-103r4), little-endian. Empty text for a shape of no place.
std::string geopackage_blob(const Shape& shape, ShapeKind kind, bool has_z, int srs_id);

/// How QGIS draws a layer of that name: a QML document with a symbol for each value of the column
/// that matters most (the type of a lane, the kind of a marking, the severity of a finding), or one
/// symbol for all.
std::string qgis_style(const Layer& layer);

}  // namespace roadbed::map::gis
