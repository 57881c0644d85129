#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace roadbed::map::inline occupancy::inline laz {

/// x, y and z as a file counts them, in steps of its scale.
using PointSteps = std::array<std::int32_t, 3>;

/// What is looked at of a point.
struct LazPoint {
  PointSteps steps;
  std::uint16_t intensity = 0;
  std::uint8_t classification = 0, return_number = 0, returns = 0;
};

/// A sum of two, modulo 2³².
inline std::int32_t moved(std::int32_t value, std::int32_t by) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) +
                                   static_cast<std::uint32_t>(by));
}

/// A little-endian integer at an offset. @pre the bytes hold it.
template <typename Integer>
Integer integer_at(std::string_view bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = sizeof(Integer); i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  }
  return static_cast<Integer>(value);
}

/// The coordinates that a point begins with.
inline PointSteps steps_at(std::string_view bytes) {
  return {integer_at<std::int32_t>(bytes, 0), integer_at<std::int32_t>(bytes, 4),
          integer_at<std::int32_t>(bytes, 8)};
}

}  // namespace roadbed::map::occupancy::laz
