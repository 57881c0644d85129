#include "roadbed/geometry/motion/rectangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::geometry::inline motion {
namespace {

Eigen::Vector2d left_of(const Eigen::Vector2d& axis) { return {-axis.y(), axis.x()}; }

double half_extent_m(const Rectangle& rectangle, const Eigen::Vector2d& direction) {
  return rectangle.half_length_m * std::abs(direction.dot(rectangle.axis)) +
         rectangle.half_width_m * std::abs(direction.dot(left_of(rectangle.axis)));
}

bool separated_along(const Eigen::Vector2d& direction, const Rectangle& a, const Rectangle& b) {
  return std::abs(direction.dot(b.centre - a.centre)) >
         half_extent_m(a, direction) + half_extent_m(b, direction);
}

// Two convex shapes are apart exactly if a line along a side of one of them separates them.
bool are_apart(const Rectangle& a, const Rectangle& b) {
  return separated_along(a.axis, a, b) || separated_along(left_of(a.axis), a, b) ||
         separated_along(b.axis, a, b) || separated_along(left_of(b.axis), a, b);
}

double squared_distance_m2(const Rectangle& rectangle, const Eigen::Vector2d& point) {
  const Eigen::Vector2d offset = point - rectangle.centre;
  const double along = std::abs(offset.dot(rectangle.axis)) - rectangle.half_length_m;
  const double across = std::abs(offset.dot(left_of(rectangle.axis))) - rectangle.half_width_m;
  const double beyond = std::max(along, 0.0), beside = std::max(across, 0.0);
  return beyond * beyond + beside * beside;
}

double squared_to_nearest_corner_m2(const Rectangle& rectangle, const Rectangle& of) {
  double nearest_m2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : of.corners()) {
    nearest_m2 = std::min(nearest_m2, squared_distance_m2(rectangle, corner));
  }
  return nearest_m2;
}

// Across and along the rectangle, from its centre.
Eigen::Vector2d in_frame_of(const Rectangle& rectangle, const Eigen::Vector2d& point) {
  const Eigen::Vector2d offset = point - rectangle.centre;
  return {offset.dot(rectangle.axis),
          rectangle.axis.x() * offset.y() - rectangle.axis.y() * offset.x()};
}

Eigen::Vector2d nearest_point_of(const Rectangle& rectangle, const Eigen::Vector2d& to) {
  const Eigen::Vector2d half(rectangle.half_length_m, rectangle.half_width_m);
  const Eigen::Vector2d local = in_frame_of(rectangle, to).cwiseMax(-half).cwiseMin(half);
  return rectangle.centre + local.x() * rectangle.axis + local.y() * left_of(rectangle.axis);
}

/// The point of `thing` that is nearest to `body`; its centre where they overlap. Disjoint convex
/// shapes are nearest at a corner of one of them.
Eigen::Vector2d nearest_to(const Rectangle& body, const Rectangle& thing) {
  Eigen::Vector2d nearest = thing.centre;
  if (motion::distance_m(body, thing) == 0.0) return nearest;
  double least_m = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Eigen::Vector2d& point) {
    const double distance_m = motion::distance_m(body, point);
    if (distance_m >= least_m) return;
    least_m = distance_m;
    nearest = point;
  };
  for (const Eigen::Vector2d& corner : thing.corners()) consider(corner);
  for (const Eigen::Vector2d& corner : body.corners()) consider(nearest_point_of(thing, corner));
  return nearest;
}

}  // namespace

std::array<Eigen::Vector2d, 4> Rectangle::corners() const {
  const Eigen::Vector2d ahead = half_length_m * axis, left = half_width_m * left_of(axis);
  return {centre - ahead - left, centre + ahead - left, centre + ahead + left,
          centre - ahead + left};
}

double Rectangle::radius_m() const { return std::hypot(half_length_m, half_width_m); }

Rectangle body_at(const Pose2& pose, const VehicleShape& shape) {
  const Eigen::Vector2d axis(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const double half_length_m = 0.5 * shape.length_m;
  return {.centre = pose.position() + (half_length_m - shape.rear_overhang_m) * axis,
          .axis = axis,
          .half_length_m = half_length_m,
          .half_width_m = 0.5 * shape.width_m};
}

double distance_m(const Rectangle& rectangle, const Eigen::Vector2d& point) {
  return std::sqrt(squared_distance_m2(rectangle, point));
}

double distance_m(const Rectangle& a, const Rectangle& b) {
  if (!are_apart(a, b)) return 0.0;
  // Disjoint convex shapes are nearest at a corner of one of them.
  return std::sqrt(
      std::min(squared_to_nearest_corner_m2(a, b), squared_to_nearest_corner_m2(b, a)));
}

std::string_view side_towards(const Rectangle& thing, const Rectangle& body) {
  constexpr double same_m = 1e-6;
  const Eigen::Vector2d at = in_frame_of(body, nearest_to(body, thing));
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

}  // namespace roadbed::geometry::motion
