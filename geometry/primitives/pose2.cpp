#include "roadbed/geometry/primitives/pose2.h"

#include <cmath>

namespace roadbed::geometry::inline primitives {

Pose2 Pose2::inverse() const {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  return {-c * x_m - s * y_m, s * x_m - c * y_m, -heading_rad};
}

Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b) {
  const double c = std::cos(a_from_b.heading_rad), s = std::sin(a_from_b.heading_rad);
  return {a_from_b.x_m + c * point_in_b.x() - s * point_in_b.y(),
          a_from_b.y_m + s * point_in_b.x() + c * point_in_b.y()};
}

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Eigen::Vector2d position = a_from_b * b_from_c.position();
  return {position.x(), position.y(), a_from_b.heading_rad + b_from_c.heading_rad};
}

}  // namespace roadbed::geometry::primitives
