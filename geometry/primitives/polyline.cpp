#include "roadbed/geometry/primitives/polyline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry::inline primitives {
namespace {

// Index of the segment that holds s: the last one that starts at or before it and has a length.
std::size_t segment_at(const std::vector<double>& stations_m, double s_m) {
  const auto after = std::upper_bound(stations_m.begin(), stations_m.end(), s_m);
  const auto index = after == stations_m.begin() ? 0 : after - stations_m.begin() - 1;
  std::size_t segment = std::min(static_cast<std::size_t>(index), stations_m.size() - 2);
  while (segment > 0 && stations_m[segment + 1] <= stations_m[segment]) --segment;
  return segment;
}

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

Polyline::Polyline(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
  if (points_.size() < 2) {
    throw std::invalid_argument(
        fmt::format("Polyline: needs at least 2 points, got {}", points_.size()));
  }
  stations_m_.reserve(points_.size());
  double s_m = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_[i].allFinite()) {
      throw std::invalid_argument(fmt::format("Polyline: point {} is not finite", i));
    }
    if (i > 0) s_m += (points_[i] - points_[i - 1]).norm();
    stations_m_.push_back(s_m);
  }
}

Eigen::Vector2d Polyline::at(double s_m) const {
  const double s = std::clamp(s_m, 0.0, length_m());
  const std::size_t i = segment_at(stations_m_, s);
  const double length_m = stations_m_[i + 1] - stations_m_[i];
  if (length_m <= 0.0) return points_[i];
  const double fraction = (s - stations_m_[i]) / length_m;
  return points_[i] + fraction * (points_[i + 1] - points_[i]);
}

Pose2 Polyline::pose_at(double s_m) const {
  const Eigen::Vector2d point = at(s_m);
  const std::size_t i = segment_at(stations_m_, std::clamp(s_m, 0.0, length_m()));
  const Eigen::Vector2d along = points_[i + 1] - points_[i];
  return {point.x(), point.y(), std::atan2(along.y(), along.x())};
}

LinePosition Polyline::project(const Eigen::Vector2d& point) const {
  double nearest_squared = std::numeric_limits<double>::infinity();
  LinePosition best;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const Eigen::Vector2d along = points_[i + 1] - points_[i];
    const double squared = along.squaredNorm();
    if (squared <= 0.0) continue;
    const Eigen::Vector2d to_point = point - points_[i];
    const double fraction = std::clamp(to_point.dot(along) / squared, 0.0, 1.0);
    const double distance_squared = (to_point - fraction * along).squaredNorm();
    if (distance_squared < nearest_squared) {
      nearest_squared = distance_squared;
      const double side = cross(along, to_point) < 0.0 ? -1.0 : 1.0;
      best = {stations_m_[i] + fraction * (stations_m_[i + 1] - stations_m_[i]),
              side * std::sqrt(distance_squared)};
    }
  }
  return best;
}

std::vector<Vector2d> simplify(std::span<const Vector2d> points, double tolerance_m) {
  if (!(tolerance_m >= 0.0) || !std::isfinite(tolerance_m)) {
    throw std::invalid_argument(
        fmt::format("simplify: tolerance must be finite and not negative, got {} m", tolerance_m));
  }
  if (points.size() < 3) return {points.begin(), points.end()};
  std::vector<bool> keeps(points.size(), false);
  keeps.front() = keeps.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  WorkBudget steps(most_steps(points.size()));
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    if (!steps.spend(last - first)) {
      std::fill(keeps.begin() + static_cast<std::ptrdiff_t>(first),
                keeps.begin() + static_cast<std::ptrdiff_t>(last), true);
      continue;
    }
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
