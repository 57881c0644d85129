#pragma once

#include <string>

#include "roadbed/map/gis/geo_tiff.h"
#include "roadbed/map/occupancy/outputs/occupancy_grid.h"

namespace roadbed::map::inline occupancy::inline outputs {

/// An octree seen from above as four bands, each NaN where there is nothing to say:
/// `occupied` 1, or 0 where it is free;
/// `lowest_m`, `highest_m` bottom of the lowest occupied cell, and top of the highest;
/// `clearance_m` from the middle of a square to the middle of the nearest occupied one in plan,
/// whatever is between, unknown space included.
/// @param name  of the octree's file, for messages.
/// @throws InputError as grid_from_above, or if a side has more than 65536 squares.
Raster raster_from_above(const OccupancySource& occupancy, const GridHeights& heights,
                         const std::string& name);

}  // namespace roadbed::map::occupancy::outputs
