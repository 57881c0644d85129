#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

#include "roadbed/map/occupancy/octree/cell_blocks.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/map/occupancy/octree/octree_data.h"
#include "roadbed/map/occupancy/octree/octree_file.h"

namespace roadbed::map::inline occupancy::inline octree {

/// What stands before the data.
struct OctreeHeader {
  double resolution_m;
  std::size_t nodes;
  Eigen::Vector3d origin_in_source;
  std::string crs;
  std::optional<SeeThroughRemoval> seen_through = {};
};

/// The header of an OctoMap file, up to its data; origin, CRS and hits that were taken away are
/// comments in it.
std::string octree_header(OctreeForm form, const OctreeHeader& header);

/// The data of a `.bt`: a cell with a hit is occupied, else one that is free is free. Written
/// straight from the blocks, children before it is known whether their parent survives: eight equal
/// leaves are taken back and become one. O(blocks).
OctreeBytes bt_data(const CellBlocks& blocks);

/// The data of an `.ot`: the log-odds of the cells, of inner nodes the greatest below them.
/// @pre every block has log-odds.
OctreeBytes ot_data(const CellBlocks& blocks);

}  // namespace roadbed::map::occupancy::octree
