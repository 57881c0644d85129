#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace roadbed::geometry::inline index {

/// Where a cell of a 2¹⁶ × 2¹⁶ grid lies along the Hilbert curve through all cells: neighbours
/// along the curve are neighbours in the grid. Hilbert 1891, doi:10.1007/BF01199431.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y);

/// The same of a point, whose cell is counted within a box that holds it.
std::uint32_t hilbert_key(const Eigen::AlignedBox2d& all, const Eigen::Vector2d& point);

/// Places of the keys in ascending order; of equal keys the first one first. O(N log N).
std::vector<std::uint32_t> order_of_keys(std::span<const std::uint32_t> keys);

}  // namespace roadbed::geometry::index
