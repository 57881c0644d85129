#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/curves/arc_length.h"
#include "roadbed/geometry/curves/cubic_spline.h"

namespace roadbed::geometry::inline curves {

/// A curve through points of the plane: x and y are cubic splines over one parameter, the length of
/// the chords, since a road that turns back is no y = f(x). Measured by true arc length.
/// Position, tangent and curvature are continuous. Immutable.
class SplineCurve {
 public:
  /// Points nearer than 1 µm to the one before are dropped.
  /// @param first_direction  in which the curve leaves the first point, of any length; none:
  /// natural.
  /// @param last_direction   in which it reaches the last one.
  /// @throws std::invalid_argument if fewer than two points are left, or one is not finite.
  static SplineCurve through(std::span<const Eigen::Vector2d> points,
                             const std::optional<Eigen::Vector2d>& first_direction = std::nullopt,
                             const std::optional<Eigen::Vector2d>& last_direction = std::nullopt);

  /// Closed through at least three points, the first one not repeated.
  static SplineCurve closed_through(std::span<const Eigen::Vector2d> points);

  double length_m() const { return arc_length_.length_m(); }

  /// Parameters of the points that the curve goes through.
  const std::vector<double>& knots() const { return x_.knots(); }

  /// Arc length at a parameter. O(log N).
  double station_at(double parameter) const;

  /// Position at arc length `s_m`, clamped to the curve. O(log N).
  Eigen::Vector2d at(double s_m) const;

  /// Unit tangent at `s_m`.
  Eigen::Vector2d tangent(double s_m) const;

  /// Curvature at `s_m` [1/m], positive to the left.
  double curvature_per_m(double s_m) const;

  /// Points that are `step_m` apart along the curve, the first and the last included: the step is
  /// shortened so that it fits a whole number of times.
  /// @throws std::invalid_argument if the step is not positive.
  std::vector<Eigen::Vector2d> resample(double step_m) const;

 private:
  SplineCurve(CubicSpline x, CubicSpline y);
  Eigen::Vector2d derivative(double parameter, int order) const;
  double parameter_at(double s_m) const;

  CubicSpline x_, y_;
  ArcLength arc_length_;
};

}  // namespace roadbed::geometry::curves
