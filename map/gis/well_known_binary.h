#pragma once

#include <string>

#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

/// A shape as a GeoPackage holds it: its header ("GP", flags, system, envelope), then well-known
/// binary (OGC 06-103r4), little-endian. Empty text for a shape of no place.
std::string geopackage_blob(const Shape& shape, ShapeKind kind, bool has_z, int srs_id);

}  // namespace roadbed::map::gis
