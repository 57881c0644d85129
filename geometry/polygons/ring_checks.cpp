#include "roadbed/geometry/polygons/ring.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

// With coordinates below kFarthest and edges that advance by kLeastAdvance of their length,
// rounding moves a point of a chain by less than 1e4 · 4e-16 · 1e6 m = 4 µm.
constexpr double kFarthest_m = 1e6;
constexpr double kLeastAdvance = 1e-4;
constexpr double kLeastGap_m = 1e-5;

std::size_t farthest_from(const Ring& ring, const Vector2d& point) {
  const auto farthest =
      std::max_element(ring.begin(), ring.end(), [&](const auto& a, const auto& b) {
        return (a - point).squaredNorm() < (b - point).squaredNorm();
      });
  return static_cast<std::size_t>(farthest - ring.begin());
}

bool advances(const std::vector<Vector2d>& chain) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Vector2d step = chain[i] - chain[i - 1];
    if (!(step.x() > kLeastAdvance * std::abs(step.y()) && step.x() > 1e-9)) return false;
  }
  return true;
}

// Whether the inner points of one chain are all on one side (1: left) of another, well off it.
bool is_beside(const std::vector<Vector2d>& chain, const std::vector<Vector2d>& other,
               double side) {
  std::size_t k = 1;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    while (other[k].x() < chain[i].x()) ++k;
    const Vector2d step = other[k] - other[k - 1];
    const double there = other[k - 1].y() + step.y() * (chain[i].x() - other[k - 1].x()) / step.x();
    if (!(side * (chain[i].y() - there) > kLeastGap_m)) return false;
  }
  return true;
}

constexpr std::size_t kMostTests = 20'000'000, kMostPerPoint = 8;

double side(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  return (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x());
}

bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

}  // namespace

bool is_surely_simple(const Ring& ring) {
  if (ring.size() < 3) return false;
  const Vector2d from = ring[farthest_from(ring, ring[0])];
  const Vector2d along = (ring[farthest_from(ring, from)] - from).normalized();
  // Points as (advance along, offset to the left).
  std::vector<Vector2d> turned;
  turned.reserve(2 * ring.size());
  for (const Vector2d& p : ring) {
    if (!(p.cwiseAbs().maxCoeff() < kFarthest_m)) return false;
    turned.emplace_back(along.dot(p), along.x() * p.y() - along.y() * p.x());
  }
  const auto by_advance = [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x(); };
  std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end(), by_advance),
              turned.end());
  const auto last = std::max_element(turned.begin(), turned.end(), by_advance);
  const std::vector<Vector2d> there(turned.begin(), last + 1);
  std::vector<Vector2d> back(last, turned.end());
  back.push_back(turned.front());
  std::reverse(back.begin(), back.end());
  if (!advances(there) || !advances(back)) return false;
  const auto apart = [&](double side) {
    return is_beside(there, back, side) && is_beside(back, there, -side);
  };
  return apart(1.0) || apart(-1.0);
}

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
