#pragma once

#include <optional>
#include <vector>

namespace roadbed::geometry::inline curves {

/// Piecewise cubic through given values, with continuous first and second derivative [paper eq.
/// 1–5]
///
///     f(x) = aᵢ + bᵢ (x − xᵢ) + cᵢ (x − xᵢ)² + dᵢ (x − xᵢ)³   on [xᵢ, xᵢ₊₁], hᵢ = xᵢ₊₁ − xᵢ
///     aᵢ = yᵢ,   bᵢ = (aᵢ₊₁ − aᵢ)/hᵢ − hᵢ/3 (cᵢ₊₁ + 2cᵢ),   cᵢ = mᵢ/2,   dᵢ = (cᵢ₊₁ − cᵢ)/(3hᵢ)
///
/// The paper's eq. 3 divides by aᵢ; it has to be hᵢ. The mᵢ are the second derivatives at the
/// knots, from a tridiagonal system. Immutable. Construction O(N), evaluation O(log N).
class CubicSpline {
 public:
  /// Second derivative zero at both ends.
  /// @param knots   N ≥ 2 finite, increasing.
  /// @param values  N finite.
  /// @throws std::invalid_argument if that is not so (the other two as well).
  static CubicSpline natural(std::vector<double> knots, std::vector<double> values);

  /// Given first derivative at the ends; natural at an end without one.
  static CubicSpline clamped(std::vector<double> knots, std::vector<double> values,
                             std::optional<double> first_slope, std::optional<double> last_slope);

  /// First and second derivative at the last knot are those at the first.
  /// @param knots   N ≥ 4.
  /// @param values  the last one equals the first one.
  static CubicSpline periodic(std::vector<double> knots, std::vector<double> values);

  const std::vector<double>& knots() const { return knots_; }

  /// Value at `x`; outside the knots the first or last cubic goes on.
  double at(double x) const { return derivative(x, 0); }

  /// Derivative of order 0 to 3 at `x`; the third one jumps at knots, where it is the right one.
  double derivative(double x, int order) const;

 private:
  struct Cubic {
    double a, b, c, d;
  };
  CubicSpline(std::vector<double> knots, const std::vector<double>& values,
              const std::vector<double>& second_derivatives);

  std::vector<double> knots_;
  std::vector<Cubic> pieces_;
};

}  // namespace roadbed::geometry::curves
