#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbed::map::lanelet2 {

using Line3 = std::vector<Eigen::Vector3d>;

/// The line between two borders, and where along it each vertex of the borders is.
struct Centreline {
  Line3 points;
  std::vector<double> left_station_m, right_station_m;  ///< in plan, not decreasing, 0 … length
};

/// The centreline that Lanelet2 gives a lanelet without one of its own: midpoints of the rungs of a
/// ladder that climbs both borders, each time to the vertex ahead, on either side, that is nearest
/// to the one opposite, unless the new rung or the centreline would cross a border.
///
///     left   ●──────●─────────●
///            │ \    │ \      / │
///     right  ●────●─┴──●────●──●      midpoint of each rung: a vertex of the centreline
///
/// Vertices that the climb passes over lie between those beside them. O(N + M) rungs, each looks
/// at most 256 vertices ahead and behind. Where two rungs are equally near or a rung just touches a
/// border, rounding decides: the first left vertex is the origin for it, so that the answer does
/// not depend on where the map has its own.
/// @param left, right  in driving direction, two points or more each.
Centreline centreline_between(const Line3& left, const Line3& right);

/// The given centreline, with the stations of the borders' vertices by the nearest point of it,
/// made to grow along the borders.
Centreline centreline_along(Line3 centre, const Line3& left, const Line3& right);

/// Whether each border runs against the driving direction: a lanelet's left border has the right
/// one to its right, whichever way its way was drawn. Lanelet2's rule: the middle vertex of the
/// other border decides.
struct Alignment {
  bool left_reversed = false, right_reversed = false;
};
Alignment align(const Line3& left, const Line3& right);

}  // namespace roadbed::map::lanelet2
