#include "roadbed/map/occupancy/rectangle_on_grid.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "roadbed/geometry/polygon.h"

namespace roadbed::map {
namespace {

Eigen::Vector2d left_of(const Eigen::Vector2d& axis) { return {-axis.y(), axis.x()}; }

// What of a convex ring lies where direction·p ≤ limit [Sutherland & Hodgman 1974].
void clip(geometry::Ring& ring, const Eigen::Vector2d& direction, double limit) {
  geometry::Ring kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double out_a = direction.dot(a) - limit, out_b = direction.dot(b) - limit;
    if (out_a <= 0.0) kept.push_back(a);
    if ((out_a < 0.0 && out_b > 0.0) || (out_a > 0.0 && out_b < 0.0)) {
      kept.push_back(a + (b - a) * (out_a / (out_a - out_b)));
    }
  }
  ring = std::move(kept);
}

}  // namespace

Eigen::Vector2d half_extent_m(const geometry::Rectangle& rectangle) {
  return rectangle.half_length_m * rectangle.axis.cwiseAbs() +
         rectangle.half_width_m * left_of(rectangle.axis).cwiseAbs();
}

double distance_to_square_m(const geometry::Rectangle& rectangle, const Eigen::Vector2d& centre,
                            double half_side_m) {
  return geometry::distance_m(rectangle, {.centre = centre,
                                          .axis = {1.0, 0.0},
                                          .half_length_m = half_side_m,
                                          .half_width_m = half_side_m});
}

double overlap_with_square_m2(const geometry::Rectangle& rectangle, const Eigen::Vector2d& centre,
                              double half_side_m) {
  const double half_diagonal_m = half_side_m * std::numbers::sqrt2;
  const Eigen::Vector2d offset = centre - rectangle.centre;
  const Eigen::Array2d local(std::abs(offset.dot(rectangle.axis)),
                             std::abs(offset.dot(left_of(rectangle.axis))));
  const Eigen::Array2d halves(rectangle.half_length_m, rectangle.half_width_m);
  if ((local >= halves + half_diagonal_m).any()) return 0.0;
  if ((local <= halves - half_diagonal_m).all()) return 4.0 * half_side_m * half_side_m;
  geometry::Ring ring;
  for (const Eigen::Vector2d& corner : rectangle.corners()) ring.push_back(corner - centre);
  clip(ring, {1, 0}, half_side_m);
  clip(ring, {-1, 0}, half_side_m);
  clip(ring, {0, 1}, half_side_m);
  clip(ring, {0, -1}, half_side_m);
  return geometry::signed_area_m2(ring);
}

}  // namespace roadbed::map
