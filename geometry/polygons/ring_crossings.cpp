#include "roadbed/geometry/polygons/ring_crossings.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostTests = 20'000'000, kMostPerPoint = 8;

double side(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  return (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x());
}

bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

}  // namespace

bool has_few_crossings(const Ring& ring) {
  // Edges in order of x are compared with those that begin before they end.
  const std::size_t n = ring.size();
  const auto end = [&](std::size_t i) -> const Vector2d& { return ring[(i + 1) % n]; };
  const auto low = [&](std::size_t i) { return std::min(ring[i].x(), end(i).x()); };
  std::vector<std::size_t> edges(n);
  std::iota(edges.begin(), edges.end(), std::size_t{0});
  std::sort(edges.begin(), edges.end(),
            [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
  std::size_t crossings = 0, tests = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = edges[i];
    const double high = std::max(ring[a].x(), end(a).x());
    for (std::size_t k = i + 1; k < n && low(edges[k]) <= high; ++k) {
      const std::size_t b = edges[k];
      if (++tests > kMostTests) return false;
      if (cross(ring[a], end(a), ring[b], end(b)) && ++crossings > kMostPerPoint * n) return false;
    }
  }
  return true;
}

}  // namespace roadbed::geometry::polygons
