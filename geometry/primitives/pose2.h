#pragma once

#include <Eigen/Core>
#include <cmath>

namespace roadbed::geometry::inline primitives {

/// A rigid motion of the plane, and the place and direction of what is moved by it.
/// `map_from_vehicle * corner_in_vehicle` is that corner in the map; frames are in the names.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< from the x axis, counter-clockwise; not wrapped

  Eigen::Vector2d position() const { return {x_m, y_m}; }
  Pose2 inverse() const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return {-c * x_m - s * y_m, s * x_m - c * y_m, -heading_rad};
  }
};

inline Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b) {
  const double c = std::cos(a_from_b.heading_rad), s = std::sin(a_from_b.heading_rad);
  return {a_from_b.x_m + c * point_in_b.x() - s * point_in_b.y(),
          a_from_b.y_m + s * point_in_b.x() + c * point_in_b.y()};
}

inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Eigen::Vector2d position = a_from_b * b_from_c.position();
  return {position.x(), position.y(), a_from_b.heading_rad + b_from_c.heading_rad};
}

}  // namespace roadbed::geometry::primitives
