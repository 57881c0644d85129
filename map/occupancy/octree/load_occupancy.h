#pragma once

#include <filesystem>
#include <span>

#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Occupancy from one `.bt` or `.ot` file, which keeps its own resolution, or from any number of
/// point clouds, which carve from their files' viewpoints.
/// @throws InputError if a file is unusable, or an octree is not the only file.
OccupancyMap load_occupancy(std::span<const std::filesystem::path> files,
                            const OccupancyOptions& options = {});

}  // namespace roadbed::map::occupancy::octree
