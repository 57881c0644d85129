#include "roadbed/geometry/primitives/polyline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/geometry/primitives/cross.h"

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
  const double share = (s - stations_m_[i]) / length_m;
  return points_[i] + share * (points_[i + 1] - points_[i]);
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
    const double share = std::clamp(to_point.dot(along) / squared, 0.0, 1.0);
    const double distance_squared = (to_point - share * along).squaredNorm();
    if (distance_squared < nearest_squared) {
      nearest_squared = distance_squared;
      const double side = cross(along, to_point) < 0.0 ? -1.0 : 1.0;
      best = {stations_m_[i] + share * (stations_m_[i + 1] - stations_m_[i]),
              side * std::sqrt(distance_squared)};
    }
  }
  return best;
}

}  // namespace roadbed::geometry::primitives
