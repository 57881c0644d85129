#pragma once

// Private to map/occupancy.

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace roadbed::map::inline occupancy::inline octree {

/// Cells in plan view, counted from the occupancy's origin, half open.
struct CellRange {
  std::int64_t from_x = 0, from_y = 0, to_x = 0, to_y = 0;

  std::int64_t width() const { return to_x - from_x; }
  std::int64_t height() const { return to_y - from_y; }
  bool empty() const { return width() <= 0 || height() <= 0; }
  std::size_t count() const {
    return empty() ? 0 : static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  }
  bool holds(std::int64_t x, std::int64_t y) const {
    return x >= from_x && y >= from_y && x < to_x && y < to_y;
  }

  /// Place of a cell, row by row. @pre holds(x, y)
  std::size_t index(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>((y - from_y) * width() + (x - from_x));
  }

  CellRange grown(std::int64_t by) const {
    return {from_x - by, from_y - by, to_x + by, to_y + by};
  }
  CellRange cut(const CellRange& other) const {
    return {std::max(from_x, other.from_x), std::max(from_y, other.from_y),
            std::min(to_x, other.to_x), std::min(to_y, other.to_y)};
  }
  CellRange joined(const CellRange& other) const {
    if (empty()) return other;
    return {std::min(from_x, other.from_x), std::min(from_y, other.from_y),
            std::max(to_x, other.to_x), std::max(to_y, other.to_y)};
  }
};

/// Whole quotient, rounded down; `b` is positive.
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// Rounded down, without a library call, as std::floor is where the processor's own rounding may
/// not be relied on.
inline std::int64_t whole_below(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

}  // namespace roadbed::map::occupancy::octree
