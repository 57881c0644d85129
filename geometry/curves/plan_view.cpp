#include "roadbed/geometry/curves/plan_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace roadbed::geometry::inline curves {
namespace {

// Gauss–Legendre nodes and weights on [−1, 1], 8 points (Abramowitz & Stegun, table 25.4).
constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290,
                                          0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};

template <typename F>
double integrate_by_gauss(const F& f, double from, double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
  }
  return half * sum;
}

// sin(x)/x and (1 − cos x)/x without cancellation at 0.
double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }
double cosc(double x) {
  const double half = 0.5 * x;
  return std::sin(half) * sinc(half);
}

PlanPoint point_on(const LineCurve&, double ds, double) { return {{ds, 0.0, 0.0}, 0.0}; }

PlanPoint point_on(const ArcCurve& arc, double ds, double) {
  const double turn = arc.curvature_per_m * ds;
  return {{ds * sinc(turn), ds * cosc(turn), turn}, arc.curvature_per_m};
}

constexpr std::size_t kMostTerms = 64;

// 1/(n + 1).
constexpr std::array<double, kMostTerms + 1> kReciprocals = [] {
  std::array<double, kMostTerms + 1> reciprocals{};
  for (std::size_t n = 0; n <= kMostTerms; ++n) reciprocals[n] = 1.0 / static_cast<double>(n + 1);
  return reciprocals;
}();

using Complex = std::complex<double>;

// ∫ exp(i (K t + R t²/2)) dt from 0 to 1, of no more than a radian. The integrand u has
// u′ = i (K + R t) u, and so the power series (n + 1) c_{n+1} = i (K c_n + R c_{n−1}); for a turn
// of a radian it ends after 20 to 40 terms, of a tenth of one after 10.
Complex short_spiral(double k, double r) {
  constexpr double kNothing = 1e-17;
  double a = 1.0, b = 0.0, last_a = 0.0, last_b = 0.0;  // c_n, c_{n−1}
  double x = 1.0, y = 0.0;
  for (std::size_t n = 0; n < kMostTerms; ++n) {
    const double next_a = -(k * b + r * last_b) * kReciprocals[n];
    const double next_b = (k * a + r * last_a) * kReciprocals[n];
    last_a = std::exchange(a, next_a);
    last_b = std::exchange(b, next_b);
    x += a * kReciprocals[n + 1];
    y += b * kReciprocals[n + 1];
    if (std::abs(a) + std::abs(b) + std::abs(last_a) + std::abs(last_b) < kNothing) break;
  }
  return {x, y};
}

// From here on the series of `far_spiral` is exact: its least term is exp(−x²/2) = 3e-18.
constexpr std::size_t kNearTurn = 40;

// The antiderivative of exp(i φ) that vanishes at infinity, at a place with φ′ = p and φ″ = r, over
// exp(i φ): integrated by parts, again and again, where p² ≥ 2·kNearTurn·|r|.
Complex far_spiral(double p, double r) {
  const double q = r / (p * p);
  Complex term(0.0, -1.0 / p), sum = 0.0;
  for (std::size_t n = 0; n < kNearTurn && std::abs(term) > 1e-18 / std::abs(p); ++n) {
    sum += term;
    const double factor = static_cast<double>(2 * n + 1) * q;
    term = {factor * term.imag(), -factor * term.real()};
  }
  return sum;
}

// The spiral that all others are parts of, ∫ exp(i u²/2) du from 0 to x (DLMF 7.2(iii)): after each
// whole radian from a table, and a short one beyond it.
Complex whole_spiral(double x) {
  const auto from_node = [](double node, double to) {
    const double step = to - node;
    return step * std::polar(1.0, 0.5 * node * node) * short_spiral(node * step, step * step);
  };
  const auto node = [](std::size_t turn) { return std::sqrt(2.0 * static_cast<double>(turn)); };
  static const std::array<Complex, kNearTurn> at_nodes = [&] {
    std::array<Complex, kNearTurn> at{};
    for (std::size_t i = 1; i < kNearTurn; ++i) at[i] = at[i - 1] + from_node(node(i - 1), node(i));
    return at;
  }();
  const double turn = 0.5 * x * x;
  Complex value;
  if (turn < static_cast<double>(kNearTurn)) {
    const auto whole_turn = static_cast<std::size_t>(turn);
    value = at_nodes[whole_turn] + from_node(node(whole_turn), std::abs(x));
  } else {
    const double limit = 0.5 * std::sqrt(std::numbers::pi);
    value = Complex(limit, limit) + std::polar(1.0, turn) * far_spiral(std::abs(x), 1.0);
  }
  return x < 0.0 ? -value : value;
}

// ∫ exp(i (K t + R t²/2)) dt from 0 to 1 in constant time.
Complex unit_spiral(double k, double r) {
  const double end = k + r;
  if (std::max(std::abs(k), std::abs(end)) <= 1.0) return short_spiral(k, r);
  const double nearest = std::min(std::abs(k), std::abs(end));
  if (k * end > 0.0 && nearest * nearest >= 2.0 * kNearTurn * std::abs(r)) {
    return std::polar(1.0, k + 0.5 * r) * far_spiral(end, r) - far_spiral(k, r);
  }
  const double root = std::sqrt(std::abs(r)), sign = r < 0.0 ? -1.0 : 1.0;
  const Complex part = (whole_spiral(sign * end / root) - whole_spiral(sign * k / root)) / root;
  return std::polar(1.0, -0.5 * k * k / r) * (r < 0.0 ? std::conj(part) : part);
}

PlanPoint point_on(const SpiralCurve& spiral, double ds, double length_m) {
  const double k0 = spiral.start_curvature_per_m;
  const double rate = (spiral.end_curvature_per_m - k0) / length_m;
  const Complex at = ds * unit_spiral(k0 * ds, rate * ds * ds);
  return {{at.real(), at.imag(), ds * (k0 + 0.5 * rate * ds)}, k0 + rate * ds};
}

// u at arc length ds of v(u): Newton on the length, which is integrated piecewise.
double poly3_u(const Poly3Curve& curve, double ds, double length_m) {
  const auto speed = [&](double u) {
    return std::hypot(1.0, curve.b + u * (2.0 * curve.c + 3.0 * curve.d * u));
  };
  const int parts = 16;
  const double step_m = std::max(length_m, std::abs(ds)) / parts;
  double u = 0.0, left_m = ds;
  const double sign = ds < 0.0 ? -1.0 : 1.0;
  for (int i = 0; i < 4 * parts; ++i) {
    const double stretch_m = integrate_by_gauss(speed, u, u + sign * step_m);
    if (std::abs(stretch_m) >= std::abs(left_m)) break;
    left_m -= stretch_m;
    u += sign * step_m;
  }
  double du = left_m / speed(u);
  for (int i = 0; i < 20; ++i) {
    const double error_m = integrate_by_gauss(speed, u, u + du) - left_m;
    du -= error_m / speed(u + du);
    if (std::abs(error_m) < 1e-13 * (1.0 + std::abs(ds))) break;
  }
  return u + du;
}

PlanPoint point_on(const Poly3Curve& curve, double ds, double length_m) {
  const double u = poly3_u(curve, ds, length_m);
  const double d1 = curve.b + u * (2.0 * curve.c + 3.0 * curve.d * u);
  const double d2 = 2.0 * curve.c + 6.0 * curve.d * u;
  const double v = curve.a + u * (curve.b + u * (curve.c + u * curve.d));
  return {{u, v, std::atan(d1)}, d2 / std::pow(1.0 + d1 * d1, 1.5)};
}

struct PolynomialValue {
  double value, d1, d2, d3;
};
PolynomialValue polynomial(const std::array<double, 4>& c, double p) {
  return {c[0] + p * (c[1] + p * (c[2] + p * c[3])), c[1] + p * (2.0 * c[2] + p * 3.0 * c[3]),
          2.0 * c[2] + 6.0 * c[3] * p, 6.0 * c[3]};
}

PlanPoint point_on(const ParamPoly3Curve& curve, double ds, double length_m) {
  const double p = curve.p_end * ds / length_m;
  const PolynomialValue u = polynomial(curve.u, p), v = polynomial(curve.v, p);
  const double speed = std::hypot(u.d1, v.d1);
  const double curvature = speed > 0.0 ? (u.d1 * v.d2 - v.d1 * u.d2) / (speed * speed * speed) : 0;
  return {{u.value, v.value, std::atan2(v.d1, u.d1)}, curvature};
}

PlanBounds bounds_of(const LineCurve&, double, double, double) {
  return {0.0, 0.0, 0.0, 0.0, 1.0, PlanBounds::Range{}};
}

PlanBounds bounds_of(const ArcCurve& arc, double, double, double) {
  const double k = std::abs(arc.curvature_per_m);
  return {k, k, 0.0, k, 1.0, PlanBounds::Range{arc.curvature_per_m, arc.curvature_per_m}};
}

PlanBounds bounds_of(const SpiralCurve& spiral, double from, double to, double length_m) {
  const double k0 = spiral.start_curvature_per_m;
  const double rate = (spiral.end_curvature_per_m - k0) / length_m;
  const auto [low, high] = std::minmax({k0 + rate * from, k0 + rate * to});
  const double k = std::max(std::abs(low), std::abs(high));
  return {k, k, std::abs(rate), k, 1.0, PlanBounds::Range{low, high}};
}

// A planar curve given by u and v with Taylor coefficients about the middle of a stretch.
PlanBounds parametric_bounds(const PolynomialValue& u, const PolynomialValue& v, double half) {
  const auto cross = [](double au, double av, double bu, double bv) {
    return std::abs(au * bv - av * bu);
  };
  const double third = std::hypot(u.d3, v.d3);
  const double second = std::hypot(u.d2, v.d2) + half * third;
  // Speed cannot fall faster than the second derivative allows.
  const double slowest = std::max(1e-9, std::hypot(u.d1, v.d1) - half * second);
  // heading′ = p′×p″ / |p′|², and p′×p″ is a quadratic with the derivatives p′×p‴ and p″×p‴.
  const double turn_d2 = cross(u.d2, v.d2, u.d3, v.d3);
  const double turn_d1 = cross(u.d1, v.d1, u.d3, v.d3);
  const double turn = cross(u.d1, v.d1, u.d2, v.d2) + half * (turn_d1 + 0.5 * half * turn_d2);
  const double squared = slowest * slowest;
  const double heading_d2 =
      (turn_d1 + half * turn_d2) / squared + 2.0 * turn * second / (squared * slowest);
  return {second, turn / squared, heading_d2, turn / slowest, slowest, std::nullopt};
}

PlanBounds bounds_of(const Poly3Curve& curve, double from, double to, double length_m) {
  // By s instead of u: |d/ds| ≤ |d/du|, as ds/du ≥ 1. For the second derivative by s,
  // position″ = κ·normal and heading″ = κ′.
  const double u0 = poly3_u(curve, from, length_m), u1 = poly3_u(curve, to, length_m);
  const double middle = 0.5 * (u0 + u1), half = 0.5 * std::abs(u1 - u0);
  const double second =
      std::abs(2.0 * curve.c + 6.0 * curve.d * middle) + half * 6.0 * std::abs(curve.d);
  return {second, second, 6.0 * std::abs(curve.d) + 3.0 * second * second,
          second, 1.0,    std::nullopt};
}

PlanBounds bounds_of(const ParamPoly3Curve& curve, double from, double to, double length_m) {
  const double scale = curve.p_end / length_m;
  const double middle = 0.5 * (from + to) * scale;
  const auto by_s = [&](PolynomialValue value) {
    return PolynomialValue{value.value, value.d1 * scale, value.d2 * scale * scale,
                           value.d3 * scale * scale * scale};
  };
  return parametric_bounds(by_s(polynomial(curve.u, middle)), by_s(polynomial(curve.v, middle)),
                           0.5 * (to - from));
}

bool is_finite(const PlanPiece& piece) {
  if (!std::isfinite(piece.s_m + piece.length_m + piece.start.x_m + piece.start.y_m +
                     piece.start.heading_rad)) {
    return false;
  }
  const PlanPoint end =
      std::visit([&](const auto& curve) { return point_on(curve, piece.length_m, piece.length_m); },
                 piece.curve);
  return std::isfinite(end.pose.x_m + end.pose.y_m + end.pose.heading_rad + end.curvature_per_m);
}

}  // namespace

double arc_length_m(const ParamPoly3Curve& curve) {
  const auto speed = [&](double p) {
    return std::hypot(polynomial(curve.u, p).d1, polynomial(curve.v, p).d1);
  };
  constexpr int parts = 16;
  double length_m = 0.0;
  for (int i = 0; i < parts; ++i) {
    length_m += integrate_by_gauss(speed, curve.p_end * i / parts, curve.p_end * (i + 1) / parts);
  }
  return length_m;
}

PlanPoint plan_point(const PlanPiece& piece, double s_m) {
  PlanPoint point = std::visit(
      [&](const auto& curve) { return point_on(curve, s_m - piece.s_m, piece.length_m); },
      piece.curve);
  point.pose = piece.start * point.pose;
  return point;
}

PlanBounds plan_bounds(const PlanPiece& piece, double from_s_m, double to_s_m) {
  return std::visit(
      [&](const auto& curve) {
        return bounds_of(curve, from_s_m - piece.s_m, to_s_m - piece.s_m, piece.length_m);
      },
      piece.curve);
}

PlanView::PlanView(std::vector<PlanPiece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) throw std::invalid_argument("PlanView: needs at least 1 piece, got 0");
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (!(pieces_[i].length_m > 0.0) || !is_finite(pieces_[i])) {
      throw std::invalid_argument(
          fmt::format("PlanView: piece {} must be finite and longer than 0 m, got {} m", i,
                      pieces_[i].length_m));
    }
    if (i > 0 && pieces_[i].s_m < pieces_[i - 1].s_m) {
      throw std::invalid_argument(fmt::format(
          "PlanView: piece {} starts at {} m, before its predecessor", i, pieces_[i].s_m));
    }
  }
}

const PlanPiece& PlanView::piece_at(double s_m) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), s_m,
                       [](double s, const PlanPiece& piece) { return s < piece.s_m; });
  return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

PlanPoint PlanView::at(double s_m, double piece_s_m) const {
  return plan_point(piece_at(piece_s_m), s_m);
}

PlanBounds PlanView::bounds(double from_s_m, double to_s_m) const {
  return plan_bounds(piece_at(0.5 * (from_s_m + to_s_m)), from_s_m, to_s_m);
}

}  // namespace roadbed::geometry::curves
