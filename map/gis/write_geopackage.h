#pragma once

#include <span>
#include <string>

#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

/// Layers as a GeoPackage (OGC 12-128r18, version 1.3): a table per layer, and `layer_styles`, from
/// which QGIS takes its colours. Same layers, same bytes: dates that the format asks for are the
/// first of 1970.
/// @param crs  of the coordinates, empty if unknown: then the layers are in metres of an undefined
///             Cartesian system.
/// @throws InputError if PROJ cannot describe the system, see projection.h.
std::string write_geopackage(std::span<const Layer> layers, const std::string& crs);

}  // namespace roadbed::map::gis
