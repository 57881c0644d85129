#include "roadbed/geometry/curves/cubic_spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace roadbed::geometry::inline curves {
namespace {

// Rows lower·m[i−1] + diagonal·m[i] + upper·m[i+1] = right.
struct Tridiagonal {
  std::vector<double> lower, diagonal, upper;
  explicit Tridiagonal(std::size_t n) : lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0) {}
};

// Thomas' algorithm; the systems of splines are diagonally dominant, so no pivoting is needed.
std::vector<double> solve(Tridiagonal system, std::vector<double> right) {
  const std::size_t n = right.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = system.lower[i] / system.diagonal[i - 1];
    system.diagonal[i] -= factor * system.upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] /= system.diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    right[i] = (right[i] - system.upper[i] * right[i + 1]) / system.diagonal[i];
  }
  return right;
}

// Tridiagonal but for the corners: row 0 has `lower[0]` in the last column, the last row
// `upper[n−1]` in the first. Sherman–Morrison: a plain system plus a product of two vectors.
std::vector<double> solve_cyclic(Tridiagonal system, const std::vector<double>& right) {
  const std::size_t n = right.size();
  const double top = system.lower[0], bottom = system.upper[n - 1];
  const double gamma = -system.diagonal[0];
  system.diagonal[0] -= gamma;
  system.diagonal[n - 1] -= top * bottom / gamma;
  std::vector<double> u(n, 0.0);
  u[0] = gamma;
  u[n - 1] = bottom;
  std::vector<double> m = solve(system, right);
  const std::vector<double> z = solve(system, u);
  const double fraction = (m[0] + top / gamma * m[n - 1]) / (1.0 + z[0] + top / gamma * z[n - 1]);
  for (std::size_t i = 0; i < n; ++i) m[i] -= fraction * z[i];
  return m;
}

void check(const std::vector<double>& knots, const std::vector<double>& values, std::size_t least) {
  if (knots.size() < least || knots.size() != values.size()) {
    throw std::invalid_argument(
        fmt::format("CubicSpline: needs at least {} knots and as many values, got {} and {}", least,
                    knots.size(), values.size()));
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]) || !std::isfinite(values[i]) ||
        (i > 0 && knots[i] <= knots[i - 1])) {
      throw std::invalid_argument(
          fmt::format("CubicSpline: knots must increase and be finite as the values, knot {} is {} "
                      "with value {}",
                      i, knots[i], values[i]));
    }
  }
}

double secant_slope(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  return (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
}

// The row of an inner knot: the first derivatives of both sides agree there.
void set_inner_row(Tridiagonal& system, std::vector<double>& right, std::size_t row, double before,
                   double after, double slope_change) {
  system.lower[row] = before;
  system.diagonal[row] = 2.0 * (before + after);
  system.upper[row] = after;
  right[row] = 6.0 * slope_change;
}

void set_inner_rows(Tridiagonal& system, std::vector<double>& right, const std::vector<double>& x,
                    const std::vector<double>& y) {
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    set_inner_row(system, right, i, x[i] - x[i - 1], x[i + 1] - x[i],
                  secant_slope(x, y, i) - secant_slope(x, y, i - 1));
  }
}

}  // namespace

CubicSpline::CubicSpline(std::vector<double> knots, const std::vector<double>& values,
                         const std::vector<double>& second_derivatives)
    : knots_(std::move(knots)) {
  pieces_.reserve(knots_.size() - 1);
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double h = knots_[i + 1] - knots_[i];
    const double c = 0.5 * second_derivatives[i], c_next = 0.5 * second_derivatives[i + 1];
    pieces_.push_back({.a = values[i],
                       .b = secant_slope(knots_, values, i) - h / 3.0 * (c_next + 2.0 * c),
                       .c = c,
                       .d = (c_next - c) / (3.0 * h)});
  }
}

CubicSpline CubicSpline::natural(std::vector<double> knots, std::vector<double> values) {
  return clamped(std::move(knots), std::move(values), std::nullopt, std::nullopt);
}

CubicSpline CubicSpline::clamped(std::vector<double> knots, std::vector<double> values,
                                 std::optional<double> first_slope,
                                 std::optional<double> last_slope) {
  check(knots, values, 2);
  const std::size_t last = knots.size() - 1;
  Tridiagonal system(knots.size());
  std::vector<double> right(knots.size(), 0.0);
  set_inner_rows(system, right, knots, values);
  if (first_slope) {
    const double change = secant_slope(knots, values, 0) - *first_slope;
    set_inner_row(system, right, 0, 0.0, knots[1] - knots[0], change);
  }
  if (last_slope) {
    const double change = *last_slope - secant_slope(knots, values, last - 1);
    set_inner_row(system, right, last, knots[last] - knots[last - 1], 0.0, change);
  }
  const std::vector<double> m = solve(std::move(system), std::move(right));
  return CubicSpline(std::move(knots), values, m);
}

CubicSpline CubicSpline::periodic(std::vector<double> knots, std::vector<double> values) {
  check(knots, values, 4);
  const std::size_t n = knots.size() - 1;
  if (values[n] != values[0]) {
    throw std::invalid_argument(
        fmt::format("CubicSpline: a periodic spline ends with its first value {}, got {}",
                    values[0], values[n]));
  }
  Tridiagonal system(n);
  std::vector<double> right(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    set_inner_row(system, right, i, knots[before + 1] - knots[before], knots[i + 1] - knots[i],
                  secant_slope(knots, values, i) - secant_slope(knots, values, before));
  }
  std::vector<double> m = solve_cyclic(std::move(system), right);
  m.push_back(m.front());
  return CubicSpline(std::move(knots), values, m);
}

double CubicSpline::derivative(double x, int order) const {
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, x);
  const auto i = static_cast<std::size_t>(after - knots_.begin()) - 1;
  const auto [a, b, c, d] = pieces_[i];
  const double t = x - knots_[i];
  switch (order) {
    case 0:
      return a + t * (b + t * (c + t * d));
    case 1:
      return b + t * (2.0 * c + t * 3.0 * d);
    case 2:
      return 2.0 * c + t * 6.0 * d;
    case 3:
      return 6.0 * d;
    default:
      throw std::invalid_argument(
          fmt::format("CubicSpline: derivatives of order 0 to 3, got {}", order));
  }
}

}  // namespace roadbed::geometry::curves
