#include "roadbed/tests/support/brute_force_distance.h"

#include <algorithm>
#include <limits>

namespace roadbed::tests {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double point_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double fraction = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - fraction * along).norm();
}

bool cross_each_other(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                      const Eigen::Vector2d& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0.0 &&
         cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
}

bool inside(const Eigen::Vector2d& p, const Quad& quad) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = cross(quad[(i + 1) % 4] - quad[i], p - quad[i]);
    left = left || side > 0.0;
    right = right || side < 0.0;
  }
  return !(left && right);
}

}  // namespace

Quad box_quad(const Eigen::Vector2d& least, const Eigen::Vector2d& most) {
  return {least, {most.x(), least.y()}, most, {least.x(), most.y()}};
}

double quad_distance(const Quad& a, const Quad& b) {
  if (inside(a[0], b) || inside(b[0], a)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const Eigen::Vector2d &p = a[i], &q = a[(i + 1) % 4], &r = b[j], &s = b[(j + 1) % 4];
      if (cross_each_other(p, q, r, s)) return 0.0;
      least = std::min({least, point_to_segment(p, r, s), point_to_segment(q, r, s),
                        point_to_segment(r, p, q), point_to_segment(s, p, q)});
    }
  }
  return least;
}

}  // namespace roadbed::tests
