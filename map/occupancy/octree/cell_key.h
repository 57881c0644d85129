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

/// A zero bit, or two, after each bit of a number below 1024.
constexpr std::uint32_t spread_bits(std::uint32_t value) {
  value = (value | value << 16) & 0x030000ffu;
  value = (value | value << 8) & 0x0300f00fu;
  value = (value | value << 4) & 0x030c30c3u;
  return (value | value << 2) & 0x09249249u;
}

/// Bits of x, y and z in turn, x lowest; 10 bits an axis.
constexpr std::uint32_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace roadbed::map::occupancy::octree
