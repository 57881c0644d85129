#pragma once

#include <string>

#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

/// A layer as FlatGeobuf (version 3), features in the order of a Hilbert curve, with its index, so
/// that a reader can ask for a box. Features of no place are left out: the format's index has no
/// word for them.
/// @param crs  of the coordinates; empty if unknown.
/// @throws InputError if PROJ cannot describe the system, see projection.h.
std::string write_flatgeobuf(const Layer& layer, const std::string& crs);

}  // namespace roadbed::map::gis
