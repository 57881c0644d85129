#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace roadbed::geometry::inline polygons {

/// A closed ring of points, the last one not repeated.
using Ring = std::vector<Eigen::Vector2d>;

/// A region with holes: the outer ring counter-clockwise, holes clockwise, all simple.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// Whether the ring falls into two chains that both run forwards along one direction and stay at
/// least 10 µm apart between their ends: then no two edges meet, whatever rounding does. Most
/// lanes' rings are so; of others it says nothing. O(N), fifty times faster than an exact test.
bool is_surely_simple(const Ring& ring);

/// Whether the edges of a ring cross each other at most eight times per point: the pieces of one
/// that folds more would take memory by the square of its length. Where edges are so long that
/// counting takes more than 20 million comparisons, they are not few either. O(N log N + K).
bool has_few_crossings(const Ring& ring);

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
/// O(N log N) for rings few of whose edges are long against the others.
/// @throws std::invalid_argument if `weld_m` is negative or not finite.
/// @throws TooMuchWork if edges pass more than twice as many points as there are, and 50,000.
Welded weld(std::vector<Ring> rings, double weld_m);

}  // namespace roadbed::geometry::polygons
