#include "roadbed/geometry/motion/rectangle.h"

#include <algorithm>
#include <cmath>

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

double nearest_corner_m(const Rectangle& rectangle, const Rectangle& of) {
  double nearest_m = distance_m(rectangle, of.centre) + of.radius_m();
  for (const Eigen::Vector2d& corner : of.corners()) {
    nearest_m = std::min(nearest_m, distance_m(rectangle, corner));
  }
  return nearest_m;
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
  const Eigen::Vector2d offset = point - rectangle.centre;
  const double along = std::abs(offset.dot(rectangle.axis)) - rectangle.half_length_m;
  const double across = std::abs(offset.dot(left_of(rectangle.axis))) - rectangle.half_width_m;
  const double beyond = std::max(along, 0.0), beside = std::max(across, 0.0);
  return std::sqrt(beyond * beyond + beside * beside);
}

double distance_m(const Rectangle& a, const Rectangle& b) {
  if (!are_apart(a, b)) return 0.0;
  // Disjoint convex shapes are nearest at a corner of one of them.
  return std::min(nearest_corner_m(a, b), nearest_corner_m(b, a));
}

}  // namespace roadbed::geometry::motion
