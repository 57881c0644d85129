#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_grid.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline outputs {

/// Which heights of an octree count [m], in source coordinates: those of cells that some of lies
/// between.
struct GridHeights {
  double from_m = -std::numeric_limits<double>::infinity();
  double to_m = std::numeric_limits<double>::infinity();
};

/// An octree seen from above: a square for each column of cells.
struct OccupancyGrid {
  double resolution_m = 0.0;               ///< side of a square
  Eigen::Vector2d corner_in_source{0, 0};  ///< of the first square, with the least x and y
  CellPlace corner{};                      ///< the lowest of its cells
  std::size_t columns = 0, rows = 0;       ///< along x, and along y
  std::vector<CellState> squares;          ///< row by row, from the least y

  CellState at(std::size_t column, std::size_t row) const {
    return squares[row * columns + column];
  }

  /// Calls `use(index)` for the squares that cells of the grid lie in.
  template <typename Use>
  void for_each_square(const CellBox& cells, const Use& use) const {
    for (std::int64_t y = cells.from[1] - corner[1]; y < cells.to[1] - corner[1]; ++y) {
      for (std::int64_t x = cells.from[0] - corner[0]; x < cells.to[0] - corner[0]; ++x) {
        use(static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x));
      }
    }
  }
};

/// Goes through all leaves that have a state, each as what of it lies between the heights.
void for_each_part(const OccupancySource& occupancy, const GridHeights& heights,
                   const std::function<void(const CellBox&, CellState)>& use);

/// A square is occupied if a cell of the heights is, else free if one is, else unknown.
/// @param name  of the octree's file, for messages.
/// @throws InputError if no cell does, or the grid has more than a hundred million squares.
OccupancyGrid grid_from_above(const OccupancySource& occupancy, const GridHeights& heights,
                              const std::string& name);

/// As an image (binary PGM) that nav2's map server reads: the first row is that of the greatest y,
/// 0 is occupied, 254 free, 205 unknown.
std::string grid_as_pgm(const OccupancyGrid& grid);

/// What goes with the image: its name, resolution, corner and thresholds (YAML, mode trinary).
std::string grid_yaml(const OccupancyGrid& grid, const std::string& image);

}  // namespace roadbed::map::occupancy::outputs
