#pragma once

// Private to map/occupancy.

#include <cstdint>
#include <optional>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/occupancy/clearance/cell_bits.h"

namespace roadbed::map::inline occupancy::inline clearance {

struct NearCell {
  double distance_m;
  std::int64_t x, y;
};

/// The set cell whose square is nearest to a rectangle, if one is within `reach_m`; 0 on overlap or
/// touch. Exact up to rounding; the same for every range that holds all cells within reach.
///
/// The distance is convex along a row and least where the row meets the rectangle, or passes its
/// next corner. So of each row only the first set cells to both sides are looked at, and eight rows
/// are put aside together where none of their cells within reach is set. O(rows).
/// @param rectangle  in metres from the corner of cell (0, 0).
/// @pre every cell within reach that counts lies in the range.
std::optional<NearCell> nearest_set_cell(const CellBits& bits, double cell_m,
                                         const geometry::Rectangle& rectangle, double reach_m);

}  // namespace roadbed::map::occupancy::clearance
