#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace roadbed::map::inline occupancy::inline laz {

// Which context a point is decoded in, by how many returns its pulse has and which of them it is:
// figures of LASzip (point10 version 2, point14 version 3).

/// How many returns lie between a point and the pulse's last one, up to 7: heights alike.
constexpr std::uint32_t return_level(std::uint32_t returns, std::uint32_t number) {
  return std::min(returns > number ? returns - number : number - returns, 7u);
}

/// [returns][number], point formats 0 to 5.
inline constexpr std::array<std::array<std::uint8_t, 8>, 8> kReturnMap{
    {{15, 14, 13, 12, 11, 10, 9, 8},
     {14, 0, 1, 3, 6, 10, 10, 9},
     {13, 1, 2, 4, 7, 11, 11, 10},
     {12, 3, 4, 5, 8, 12, 12, 11},
     {11, 6, 7, 8, 9, 13, 13, 12},
     {10, 10, 11, 12, 13, 14, 14, 13},
     {9, 10, 11, 12, 13, 14, 15, 14},
     {8, 9, 10, 11, 12, 13, 14, 15}}};

/// [returns][number], point formats 6 to 10.
inline constexpr std::array<std::array<std::uint8_t, 16>, 16> kReturnMap6{
    {{0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
     {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
     {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
     {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5}}};

/// Context of a coordinate by how many bits the one before it had: 0, 2, 4 … up to `most`.
constexpr std::uint32_t even_up_to(std::uint32_t k, std::uint32_t most) {
  return k < most ? k & ~1u : most;
}

}  // namespace roadbed::map::occupancy::laz
