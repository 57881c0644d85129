#include "roadbed/geometry/polygons/convex_overlap.h"

#include <algorithm>
#include <limits>

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

const Vector2d& next_of(const Ring& ring, std::size_t i) { return ring[(i + 1) % ring.size()]; }

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// How far `b` reaches over the sides of `a`, at the side that it reaches over least; negative
/// where a side has all of it outside.
double depth_over_sides_m(const Ring& a, const Ring& b) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector2d side = next_of(a, i) - a[i];
    const Vector2d inward = Vector2d(-side.y(), side.x()).normalized();
    double deepest_m = -std::numeric_limits<double>::infinity();
    for (const Vector2d& point : b) deepest_m = std::max(deepest_m, inward.dot(point - a[i]));
    least_m = std::min(least_m, deepest_m);
  }
  return least_m;
}

/// What of a ring lies to the left of a line [Sutherland 1974, doi:10.1145/360767.360802].
Ring cut_left_of(const Ring& ring, const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  Ring left;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], &b = next_of(ring, i);
    const double side_a = cross(along, a - from), side_b = cross(along, b - from);
    if (side_a >= 0.0) left.push_back(a);
    if ((side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0)) {
      left.push_back(a + side_a / (side_a - side_b) * (b - a));
    }
  }
  return left;
}

double area_of_m2(const Ring& ring) {
  double twice_m2 = 0.0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    twice_m2 += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  }
  return 0.5 * twice_m2;
}

}  // namespace

Overlap convex_overlap(const Ring& a, const Ring& b) {
  const double depth_m = std::min(depth_over_sides_m(a, b), depth_over_sides_m(b, a));
  if (!(depth_m > 0.0)) return {};
  Ring both = a;
  for (std::size_t i = 0; i < b.size() && !both.empty(); ++i) {
    both = cut_left_of(both, b[i], next_of(b, i));
  }
  return {depth_m, std::max(0.0, area_of_m2(both))};
}

}  // namespace roadbed::geometry::polygons
