#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline primitives {

/// A place beside a line: `s` along it, `d` from it, positive to the left.
struct LinePosition {
  double s_m = 0.0;
  double d_m = 0.0;
};

/// Straight segments through points, measured by arc length. Immutable.
class Polyline {
 public:
  Polyline() = default;

  /// @param points  N ≥ 2 finite points [m]; equal neighbours are allowed and have no length.
  /// @throws std::invalid_argument if there are fewer than two points or one is not finite.
  explicit Polyline(std::vector<Eigen::Vector2d> points);

  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  const std::vector<double>& stations_m() const { return stations_m_; }
  double length_m() const { return stations_m_.empty() ? 0.0 : stations_m_.back(); }

  /// Point at `s_m`, clamped to the line. O(log N).
  Eigen::Vector2d at(double s_m) const;

  /// Point at `s_m` with the direction of the segment there.
  Pose2 pose_at(double s_m) const;

  /// Nearest place on the line; of equally near ones, the one with the smallest s. Beyond an end,
  /// s is that of the end and |d| the distance to it. O(N).
  LinePosition project(const Eigen::Vector2d& point) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> stations_m_;
};

/// A line through some of its points that keeps within `tolerance_m` of all of them; both ends
/// stay. Douglas and Peucker 1973, doi:10.3138/FM57-6770-U75U-7727. O(N log N) for smooth lines.
/// @throws std::invalid_argument if the tolerance is negative or not finite.
std::vector<Eigen::Vector2d> simplify(std::span<const Eigen::Vector2d> points, double tolerance_m);

}  // namespace roadbed::geometry::primitives
