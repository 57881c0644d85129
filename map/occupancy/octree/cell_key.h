#pragma once

// Private to map/occupancy.

#include <array>
#include <cstdint>

namespace roadbed::map::inline occupancy::inline octree {

/// Key of a cell at the finest level: 16 bits an axis, as in OctoMap.
using CellKey = std::array<std::uint16_t, 3>;

/// Cells on either side of the origin.
inline constexpr double kHalfRange = 32768.0;

/// A bit a cell of a cube of 8×8×8. Cells are in Morton order, x lowest, so that a byte is a cube
/// of 2×2×2 cells and a word one of 4×4×4: the nodes of an octree.
using BlockBits = std::array<std::uint64_t, 8>;

}  // namespace roadbed::map::occupancy::octree
