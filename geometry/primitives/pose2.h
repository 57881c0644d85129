#pragma once

#include <Eigen/Core>

namespace roadbed::geometry::inline primitives {

/// A rigid motion of the plane, and the place and direction of what is moved by it.
/// `map_from_vehicle * corner_in_vehicle` is that corner in the map; frames are in the names.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< from the x axis, counter-clockwise; not wrapped

  Eigen::Vector2d position() const { return {x_m, y_m}; }
  Pose2 inverse() const;
};

Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b);
Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);

}  // namespace roadbed::geometry::primitives
