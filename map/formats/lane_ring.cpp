#include "roadbed/map/formats/lane_ring.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace roadbed::map {
namespace {

constexpr std::size_t kMostTests = 20'000'000;

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& point) {
  return (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x());
}

bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d) {
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

// Whether the ring's edges cross no more often than a few times each: a ring that folds more would
// cost the exact repair the square of its length in memory. Edges are compared in order of x with
// those that begin before they end; a ring in which these are very many is refused as well.
bool is_repairable(const geometry::Ring& ring) {
  const std::size_t n = ring.size();
  const auto end = [&](std::size_t i) -> const Eigen::Vector2d& { return ring[(i + 1) % n]; };
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
      if (cross(ring[a], end(a), ring[b], end(b)) && ++crossings > 8 * n) return false;
    }
  }
  return true;
}

}  // namespace

geometry::Ring simple_ring(geometry::Ring ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return {};
  if (geometry::signed_area_m2(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  if (geometry::signed_area_m2(ring) > 0.0 && geometry::is_simple(ring)) return ring;
  if (!is_repairable(ring)) return {};
  geometry::Ring largest;
  for (geometry::Polygon& part : geometry::make_simple(ring)) {
    if (largest.empty() ||
        geometry::signed_area_m2(part.outer) > geometry::signed_area_m2(largest)) {
      largest = std::move(part.outer);
    }
  }
  return largest;
}

geometry::Ring lane_ring(const geometry::Polyline& left_in_map,
                         const geometry::Polyline& right_in_map) {
  geometry::Ring ring = right_in_map.points();
  ring.insert(ring.end(), left_in_map.points().rbegin(), left_in_map.points().rend());
  return simple_ring(std::move(ring));
}

}  // namespace roadbed::map
