#include "roadbed/planning/obstacles/body_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline obstacles {
namespace {

using Eigen::Vector2d;
using geometry::Rectangle;

// Across and along the rectangle, from its centre.
Vector2d in_frame_of(const Rectangle& rectangle, const Vector2d& point) {
  const Vector2d offset = point - rectangle.centre;
  return {offset.dot(rectangle.axis),
          rectangle.axis.x() * offset.y() - rectangle.axis.y() * offset.x()};
}

Vector2d nearest_point_of(const Rectangle& rectangle, const Vector2d& to) {
  const Vector2d half(rectangle.half_length_m, rectangle.half_width_m);
  const Vector2d local = in_frame_of(rectangle, to).cwiseMax(-half).cwiseMin(half);
  const Vector2d left(-rectangle.axis.y(), rectangle.axis.x());
  return rectangle.centre + local.x() * rectangle.axis + local.y() * left;
}

/// The point of `thing` that is nearest to `body`; its centre where they overlap. Disjoint convex
/// shapes are nearest at a corner of one of them.
Vector2d nearest_to(const Rectangle& body, const Rectangle& thing) {
  Vector2d nearest = thing.centre;
  if (geometry::distance_m(body, thing) == 0.0) return nearest;
  double least_m = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector2d& point) {
    const double distance_m = geometry::distance_m(body, point);
    if (distance_m >= least_m) return;
    least_m = distance_m;
    nearest = point;
  };
  for (const Vector2d& corner : thing.corners()) consider(corner);
  for (const Vector2d& corner : body.corners()) consider(nearest_point_of(thing, corner));
  return nearest;
}

}  // namespace

std::string_view side_towards(const Rectangle& thing, const Rectangle& body) {
  constexpr double same_m = 1e-6;
  const Vector2d at = in_frame_of(body, nearest_to(body, thing));
  const double ahead_m = std::abs(at.x()) - body.half_length_m;
  const double aside_m = std::abs(at.y()) - body.half_width_m;
  const bool front = at.x() > 0.0, left = at.y() > 0.0;
  if (ahead_m > same_m && aside_m > same_m) {
    constexpr std::array<std::string_view, 4> corners{"rear right corner", "rear left corner",
                                                      "front right corner", "front left corner"};
    return corners[(front ? 2u : 0u) + (left ? 1u : 0u)];
  }
  if (ahead_m > aside_m) return front ? "front" : "rear";
  return left ? "left side" : "right side";
}

}  // namespace roadbed::planning::obstacles
