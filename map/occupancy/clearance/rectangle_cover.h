#pragma once

// Private to map/occupancy: how much of each cell of a grid a rectangle covers.

#include <cstddef>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/occupancy/octree/cell_range.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Half the sides of the rectangle's bounding box, along x and y.
Eigen::Vector2d half_extent_m(const geometry::Rectangle& rectangle);

/// Fraction of each cell that a rectangle covers, 0 … 1: exact up to rounding, in O(cells of its
/// bounding box). Each side adds what lies to its right, signed, to the cells that it crosses; the
/// sums along the rows are the fractions [Levien 2012, font-rs].
class RectangleCover {
 public:
  /// @param rectangle  in metres from the corner of cell (0, 0).
  RectangleCover(const geometry::Rectangle& rectangle, double cell_m);

  /// Cells that a rectangle may touch, with up to two columns more on the right.
  static CellRange cells_touched(const geometry::Rectangle& rectangle, double cell_m);

  const CellRange& range() const { return range_; }  ///< of `cells_touched`
  double fraction(std::int64_t x, std::int64_t y) const { return fractions_[range_.index(x, y)]; }

  /// Shares of a row's cells, from the first of the range on.
  const double* row(std::int64_t y) const { return &fractions_[range_.index(range_.from_x, y)]; }

 private:
  void add_side(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  void add_in_row(std::size_t row, double from_x, double to_x, double rise);

  CellRange range_;
  std::vector<double> fractions_;
};

}  // namespace roadbed::map::occupancy::clearance
