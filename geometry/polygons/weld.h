#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline polygons {

/// Rings after welding, and what it did to them.
struct Welded {
  std::vector<Ring> rings;
  std::size_t moved_points = 0;  ///< that became another point, and corners given to edges
  double most_moved_m = 0.0;     ///< of points, and of edges at their new corners
};

/// Makes rings that nearly touch share their vertices, so that a union leaves no hairline gaps.
///
/// First, points within `weld_m` of a point that was kept become that point; points are kept in
/// lexicographic order, so the result does not depend on the order of the rings. Then every edge
/// that passes a kept point within `weld_m` gets it as a vertex:
///
///      ●───────────────●            ●─────╮ ╭─────●
///              ● ≤ weld_m     ▶           ╰●╯           ● kept points
///
/// No point moves by more than `weld_m`, no edge by more than twice that. Repeated points are
/// dropped; rings of fewer than three points become empty. 0 only drops repeated points.
/// O(N log N) for rings whose edges are short against the whole.
/// @throws std::invalid_argument if `weld_m` is negative or not finite.
Welded weld(std::vector<Ring> rings, double weld_m);

}  // namespace roadbed::geometry::polygons
