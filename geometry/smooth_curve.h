#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/arc_length.h"
#include "roadbed/geometry/cardinal_spline.h"
#include "roadbed/geometry/polyline.h"

namespace roadbed::geometry {

/// A place on a smooth curve. Derivatives are with respect to arc length.
struct CurvePoint {
  double s_m = 0.0;
  Eigen::Vector2d position{0, 0};
  double heading_rad = 0.0;                 ///< continuous along the curve, not wrapped
  std::array<double, 5> curvature_per_m{};  ///< κ, κ′, κ″, κ‴, κ⁗ [1/m … 1/m⁵], + to the left
};

/// A uniform B-spline of degree seven in the plane, measured by true arc length: position, heading,
/// κ, κ′, κ″, κ‴ and κ⁗ are continuous, and all of them are exact derivatives of the same curve.
/// Before its start and past its end the curve goes on straight. Immutable.
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

  /// Point at arc length `s_m`. O(log N), a few µs.
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
  CurvePoint point_at(double u, double s_m) const;
  double foot_near(const Eigen::Vector2d& point, std::size_t knot) const;
  std::size_t downhill(const Eigen::Vector2d& point, std::size_t knot) const;
  double nearest_foot(const Eigen::Vector2d& point) const;
  LinePosition beside(const Eigen::Vector2d& point, double u) const;

  double knot_distance_ = 1.0;
  std::vector<Span> spans_;
  std::vector<Eigen::Vector2d> knot_points_;
  std::vector<double> knot_headings_rad_;
  ArcLength arc_length_;
};

}  // namespace roadbed::geometry
