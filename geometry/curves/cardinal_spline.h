#pragma once

#include <array>
#include <cstddef>

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

}  // namespace roadbed::geometry::curves
