#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadbed::map {

/// For every cell of a `width`×`height` grid (row by row) the Euclidean distance, in cells, from
/// its centre to the nearest centre of a cell that is set; +∞ if none is. Exact, then rounded down
/// to a float. O(cells): lower envelope of parabolas, row by row after column by column
/// [Felzenszwalb & Huttenlocher 2012, doi:10.4086/toc.2012.v008a019; in whole numbers as in
/// Meijster et al. 2000].
/// @throws std::invalid_argument if `set` has another size or a side is over 65536 cells.
std::vector<float> distances_to_set(const std::vector<std::uint8_t>& set, std::size_t width,
                                    std::size_t height);

}  // namespace roadbed::map
