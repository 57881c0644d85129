#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/octree/merge_options.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Occupancies put together cell by cell, or a part of one. They are read piece by piece, cubes of
/// 1024 cells or tiles one after the other, so that of tiled ones little is in memory at a time.
class OccupancyMerge {
 public:
  /// @param sources  outlive it. The cells of all are counted from the origin of the first.
  /// @throws InputError if their cells are not in one grid.
  /// @throws std::invalid_argument if there is none.
  explicit OccupancyMerge(std::vector<NamedOccupancy> sources, MergeOptions options = {});

  /// As the bytes of a `.bt`. Without a cell the file has none. O(leaves · levels below a cube).
  /// @throws InputError if what stays is wider than an octree's 65536 cells, or as reading tiles
  ///         does.
  OccupancyMap::File bt() const;

  /// As the bytes of an `.ot`.
  OccupancyMap::File ot() const;

  /// Hands out tiles, each when it is made, and returns their index.
  /// @param side_cells  of `tile_side_cells`.
  /// @throws InputError if what stays is higher than 65536 cells, or as reading tiles does.
  using Write = std::function<void(const std::string& file, std::string_view bytes)>;
  TilesIndex tiles(std::int64_t side_cells, const Write& write) const;

 private:
  struct Frame;
  Frame frame_of_one_octree() const;
  OccupancyMap::File file(bool as_log_odds) const;

  std::vector<NamedOccupancy> sources_;
  MergeOptions options_;
  CellGrid grid_;
  CellBox cells_;                  // around what may stay
  std::vector<CellBox> measured_;  // where sources hold something: tiles, or a box for an octree
  std::optional<SeeThroughRemoval> seen_through_;
};

}  // namespace roadbed::map::occupancy::octree
