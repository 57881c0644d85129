#pragma once

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry::inline polygons {

/// How far two shapes reach into each other.
struct Overlap {
  double depth_m = 0.0;  ///< the shortest way by which one can be moved to part them
  double area_m2 = 0.0;  ///< of what both cover
};

/// Of two convex polygons, counter-clockwise; both numbers are 0 where these touch or are apart.
/// The depth is that along a normal of one of their sides, as the Minkowski difference of convex
/// polygons has no others. O(sides²).
Overlap convex_overlap(const Ring& a, const Ring& b);

}  // namespace roadbed::geometry::polygons
