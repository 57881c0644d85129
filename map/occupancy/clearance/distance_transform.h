#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadbed::map::inline occupancy::inline clearance {

/// A part of a grid, half open.
struct CellWindow {
  std::size_t from_x, from_y, to_x, to_y;
};

/// For every cell of a `width`×`height` grid (row by row) the Euclidean distance, in cells, from
/// its centre to the nearest centre of a cell that is set; +∞ if none is. Exact, then rounded down
/// to a float. O(cells): lower envelope of parabolas, row by row after column by column
/// [Felzenszwalb & Huttenlocher 2012, doi:10.4086/toc.2012.v008a019; in whole numbers as in
/// Meijster et al. 2000].
/// @throws std::invalid_argument if `set` has another size or a side is over 65536 cells.
std::vector<float> distances_to_set(const std::vector<std::uint8_t>& set, std::size_t width,
                                    std::size_t height);

/// The same for the cells of a window only, row by row, to what is set in the whole grid. The cost
/// is little more than a look at each cell outside the window's rows.
/// @throws std::invalid_argument also if the window leaves the grid.
std::vector<float> distances_to_set(const std::vector<std::uint8_t>& set, std::size_t width,
                                    std::size_t height, const CellWindow& window);

}  // namespace roadbed::map::occupancy::clearance
