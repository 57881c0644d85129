#pragma once

#include <span>

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline polygons {

/// Corners of the convex hull of points, counter-clockwise; points on an edge are no corners. Fewer
/// than three where all lie on a line. O(N log N), by CGAL with exact predicates.
Ring convex_hull(std::span<const Eigen::Vector2d> points);

}  // namespace roadbed::geometry::polygons
