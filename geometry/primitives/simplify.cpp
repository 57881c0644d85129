#include "roadbed/geometry/primitives/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace roadbed::geometry::inline primitives {
namespace {

using Eigen::Vector2d;

/// From the segment a … b.
double distance_m(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double ratio = squared > 0.0 ? std::clamp((point - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (a + ratio * along - point).norm();
}

struct Farthest {
  std::size_t index;
  double distance_m;
};

Farthest farthest_between(std::span<const Vector2d> points, std::size_t first, std::size_t last) {
  Farthest farthest{first, 0.0};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double off_m = distance_m(points[first], points[last], points[i]);
    if (off_m > farthest.distance_m) farthest = {i, off_m};
  }
  return farthest;
}

}  // namespace

std::vector<Vector2d> simplify(std::span<const Vector2d> points, double tolerance_m) {
  if (!(tolerance_m >= 0.0) || !std::isfinite(tolerance_m)) {
    throw std::invalid_argument(
        fmt::format("simplify: tolerance must be finite and not negative, got {} m", tolerance_m));
  }
  if (points.size() < 3) return {points.begin(), points.end()};
  std::vector<bool> keeps(points.size(), false);
  keeps.front() = keeps.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Farthest farthest = farthest_between(points, first, last);
    if (farthest.distance_m <= tolerance_m) continue;
    keeps[farthest.index] = true;
    open.emplace_back(first, farthest.index);
    open.emplace_back(farthest.index, last);
  }
  std::vector<Vector2d> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (keeps[i]) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace roadbed::geometry::primitives
