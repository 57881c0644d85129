#pragma once

// Private to map/occupancy.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/octree/merge_options.h"
#include "roadbed/map/occupancy/octree/octree_data.h"
#include "roadbed/map/occupancy/octree/scan_accumulator.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Leaves of some occupancies as the data of one file. From the root down, a cube is one leaf where
/// each leaf that meets it fills it, and else divided; cubes of 8×8×8 cells are filled in.
class MergedTree {
 public:
  /// @param grid     in which cells are counted.
  /// @param wanted   cells that the tree is of, within 65536 a side of `corner`.
  /// @param corner   the cell in the root's lowest corner.
  MergedTree(std::span<const NamedOccupancy> sources, const MergeOptions& options,
             const CellGrid& grid, const CellBox& wanted, const CellPlace& corner);

  /// O(leaves · levels below a cube of 1024 cells); 100,000 leaves are in memory at a time.
  OctreeBytes bt() const;
  OctreeBytes ot() const;

 private:
  /// A leaf, or what of it lies in the wanted cells.
  struct Leaf {
    CellBox cells;
    double log_odds;
  };
  using Leaves = std::vector<Leaf>;

  template <typename Writer>
  class Assembly;

  static CellBox cube(const CellPlace& from, std::int64_t side);
  static CellBox child_of(const CellBox& cube, std::size_t child);

  std::optional<Leaves> leaves_in(const CellBox& cube, std::size_t most) const;
  Stays stays_of(const CellBox& cube) const;
  float joined(const Leaves& leaves) const;
  void add_to(double& sum, double log_odds) const;
  float within_limits(double sum) const;
  std::array<float, 512> cells_of(const CellBox& block, const Leaves& leaves, Stays stays) const;

  std::span<const NamedOccupancy> sources_;
  const MergeOptions& options_;
  const CellGrid& grid_;
  double resolution_m_;
  CellBox wanted_;
  CellPlace corner_;
  LogOddsRule rule_ = LogOddsRule::of_octomap();
};

}  // namespace roadbed::map::occupancy::octree
