#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/occupancy/clearance/field_region.h"
#include "roadbed/map/occupancy/clearance/plan_grid.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Layers of a column whose whole height in the band was measured.
inline constexpr std::int64_t kGroundRelativeLayers = 1000;

/// What leaves fill of a band that follows the ground, column by column: the ground is level over a
/// column, at its height in the middle. Cells that are alike and beside each other share a slab.
/// @param range  what matters, in cells from the origin.
/// @pre `band.ground` is there.
std::vector<Slab> ground_relative_columns(const std::vector<OccupancyCell>& leaves,
                                          const HeightBand& band,
                                          const Eigen::Vector3d& origin_in_source, double cell_m,
                                          const CellRange& range);

}  // namespace roadbed::map::occupancy::clearance
