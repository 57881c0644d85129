#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry {

inline double distance_to_ring_m(const Ring& ring, const Eigen::Vector2d& point) {
  double least_m = 1e300;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i], along = ring[(i + 1) % ring.size()] - a;
    const double fraction = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least_m = std::min(least_m, (a + fraction * along - point).norm());
  }
  return least_m;
}

}  // namespace roadbed::geometry
