#pragma once

#include <Eigen/Core>

namespace roadbed::geometry::inline primitives {

/// z of the cross product of two vectors in the plane, [m²] for lengths: |a| |b| sin of the angle
/// from a to b, greater than zero where b points to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace roadbed::geometry::primitives
