#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace roadbed::geometry::inline primitives {

/// Distance of a point to the nearest place of a segment from a to b, which may have no length [m].
inline double distance_to_segment_m(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                                    const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double square_m2 = along.squaredNorm();
  const double share =
      square_m2 > 0.0 ? std::clamp((point - a).dot(along) / square_m2, 0.0, 1.0) : 0.0;
  return (point - a - share * along).norm();
}

}  // namespace roadbed::geometry::primitives
