#include "roadbed/geometry/polygons/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>

#include <iterator>
#include <vector>

namespace roadbed::geometry::inline polygons {

Ring convex_hull(std::span<const Eigen::Vector2d> points) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  std::vector<Point> given, corners;
  given.reserve(points.size());
  for (const Eigen::Vector2d& point : points) given.emplace_back(point.x(), point.y());
  CGAL::convex_hull_2(given.begin(), given.end(), std::back_inserter(corners));
  Ring hull;
  for (const Point& corner : corners) hull.emplace_back(corner.x(), corner.y());
  return hull;
}

}  // namespace roadbed::geometry::polygons
