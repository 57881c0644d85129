#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/curves/arc_length.h"
#include "roadbed/geometry/curves/curve_table.h"
#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::geometry::inline curves {

/// Degree of smooth curves: sixth derivatives are continuous, hence curvature with its first four.
inline constexpr std::size_t kSplineDegree = 7;
inline constexpr std::size_t kSplineOrder = kSplineDegree + 1;

/// Coefficients of t⁰ … t⁷ on one span, 0 ≤ t ≤ 1.
using SpanPolynomial = std::array<double, kSplineOrder>;

/// On a span between two knots of a uniform B-spline, Σⱼ basis[j](t) · control point k+j.
/// Cox and de Boor's recursion, on coefficients.
const std::array<SpanPolynomial, kSplineOrder>& cardinal_basis();

/// Value of the derivative of that order with respect to t.
double evaluate(const SpanPolynomial& polynomial, double t, int order = 0);

/// A uniform B-spline of degree seven in the plane, measured by true arc length: position, heading,
/// κ, κ′, κ″, κ‴ and κ⁗ are continuous, and all of them are exact derivatives of the same curve.
/// Before its start and past its end the curve goes on straight. Immutable.
///
/// Points by arc length come from a CurveTable of four pieces per span, which keeps to the spline
/// within 1e-10 of the knot distance.
class SmoothCurve {
 public:
  SmoothCurve() = default;

  /// @param control_points  at least 8; the curve has 7 spans fewer than these.
  /// @param knot_distance   of the parameter; where the parameter is about arc length, so is this.
  /// @throws std::invalid_argument if there are too few points, or the curve stands still somewhere
  ///         at a knot.
  SmoothCurve(std::span<const Eigen::Vector2d> control_points, double knot_distance);

  double length_m() const { return arc_length_.length_m(); }

  /// Stations of the knots.
  const std::vector<double>& knots_m() const { return arc_length_.stations_m(); }

  /// Point at arc length `s_m`. O(1), about 0.1 µs.
  CurvePoint at(double s_m) const;

  /// Foot of the perpendicular from a point: the nearest one of the whole curve, O(N); with
  /// `near_s_m` the nearest one downhill from there, O(1). `at(s)` plus d to the left is the point.
  LinePosition project(const Eigen::Vector2d& point,
                       std::optional<double> near_s_m = std::nullopt) const;

 private:
  struct Span {
    Eigen::Vector2d origin;
    SpanPolynomial x, y;  // relative to origin
  };

  std::size_t span_of(double u) const;
  Eigen::Vector2d derivative(double u, int order) const;
  double speed(double u) const { return derivative(u, 1).norm(); }
  CurvePoint point_at(std::size_t span, double t, double s_m) const;
  CurveTable make_table() const;
  double foot_near(const Eigen::Vector2d& point, std::size_t knot) const;
  std::size_t downhill(const Eigen::Vector2d& point, std::size_t knot) const;
  double nearest_foot(const Eigen::Vector2d& point) const;
  LinePosition beside(const Eigen::Vector2d& point, double u) const;

  double knot_distance_ = 1.0;
  std::vector<Span> spans_;
  std::vector<Eigen::Vector2d> knot_points_;
  std::vector<double> knot_headings_rad_;
  ArcLength arc_length_;
  CurveTable table_;
};

}  // namespace roadbed::geometry::curves
