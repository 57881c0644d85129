#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/gis/layers.h"
#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/map/occupancy/outputs/occupancy_grid.h"

namespace roadbed::map::inline occupancy::inline outputs {

/// Occupied cells, in boxes that do not overlap: cells in a row along x are joined, then equal rows
/// along y, then equal layers along z. Counted from the octree's origin, ordered by z, y and x.
/// @param heights  a cell counts if some of it lies between them.
/// @param name     of the octree's file, for messages.
/// @throws InputError if there are more than a hundred million rows.
std::vector<CellBox> occupied_boxes(const OccupancySource& occupancy, const GridHeights& heights,
                                    const std::string& name);

/// Boxes as rectangles in plan view with `from_z_m` and `to_z_m`, in source coordinates.
Layer layer_of_boxes(const OccupancySource& occupancy, const std::vector<CellBox>& boxes);

}  // namespace roadbed::map::occupancy::outputs
