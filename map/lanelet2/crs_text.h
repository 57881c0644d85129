#pragma once

#include <optional>
#include <string_view>

#include "roadbed/map/files/transverse_mercator.h"

namespace roadbed::map::lanelet2 {

/// The grid that a CRS text names, where it is a transverse Mercator one on WGS 84 or GRS 80 (their
/// grids differ by less than 0.1 mm): "EPSG:326zz", "EPSG:327zz", "+proj=utm …", "+proj=tmerc …".
/// None for everything else; needs no PROJ.
std::optional<TransverseMercator> transverse_mercator_of(std::string_view crs);

}  // namespace roadbed::map::lanelet2
