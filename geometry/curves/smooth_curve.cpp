#include "roadbed/geometry/curves/smooth_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/geometry/curves/taylor.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::geometry::inline curves {
namespace {

// Σⱼ basisⱼ cⱼ of one span, relative to its first control point so that no digits are lost.
void accumulate(SpanPolynomial& sum, const SpanPolynomial& basis, double factor) {
  for (std::size_t i = 0; i < kSplineOrder; ++i) sum[i] += factor * basis[i];
}

// Series of the first derivative with respect to u at t = u / knot distance.
Taylor<6> first_derivative_series(const SpanPolynomial& p, double t, double knot_distance) {
  Taylor<6> series{};
  double scale = 1.0 / knot_distance, factorial = 1.0;
  for (int k = 0; k < 6; ++k) {
    series[static_cast<std::size_t>(k)] = evaluate(p, t, k + 1) * scale / factorial;
    scale /= knot_distance;
    factorial *= k + 1;
  }
  return series;
}

// d/ds of a function of u, where du/ds has the series `slowness`.
template <std::size_t N>
Taylor<N - 1> along_arc(const Taylor<N>& f, const Taylor<5>& slowness) {
  return product(slope(f), truncated<N - 1>(slowness));
}

// κ = (x′y″ − y′x″) / (x′² + y′²)^(3/2) and its derivatives by arc length.
std::array<double, 5> curvatures(const Taylor<6>& dx, const Taylor<6>& dy) {
  const Taylor<5> x1 = truncated<5>(dx), y1 = truncated<5>(dy), x2 = slope(dx), y2 = slope(dy);
  Taylor<5> turning = product(x1, y2), squared_speed = product(x1, x1);
  const Taylor<5> other_turning = product(y1, x2), other_square = product(y1, y1);
  for (std::size_t i = 0; i < 5; ++i) {
    turning[i] -= other_turning[i];
    squared_speed[i] += other_square[i];
  }
  const Taylor<5> slowness = power(squared_speed, -0.5);
  const Taylor<5> curvature = product(turning, power(squared_speed, -1.5));
  const Taylor<4> first = along_arc(curvature, slowness);
  const Taylor<3> second = along_arc(first, slowness);
  const Taylor<2> third = along_arc(second, slowness);
  const Taylor<1> fourth = along_arc(third, slowness);
  return {curvature[0], first[0], second[0], third[0], fourth[0]};
}

}  // namespace

SmoothCurve::SmoothCurve(std::span<const Eigen::Vector2d> control_points, double knot_distance)
    : knot_distance_(knot_distance) {
  if (control_points.size() < kSplineOrder || !(knot_distance > 0.0)) {
    throw std::invalid_argument(
        fmt::format("SmoothCurve: needs {} control points and a positive knot distance, got {}, {}",
                    kSplineOrder, control_points.size(), knot_distance));
  }
  std::vector<double> parameters{0.0};
  for (std::size_t k = 0; k + kSplineDegree < control_points.size(); ++k) {
    Span span{control_points[k], {}, {}};
    for (std::size_t j = 0; j < kSplineOrder; ++j) {
      const Eigen::Vector2d relative = control_points[k + j] - span.origin;
      accumulate(span.x, cardinal_basis()[j], relative.x());
      accumulate(span.y, cardinal_basis()[j], relative.y());
    }
    spans_.push_back(span);
    parameters.push_back(static_cast<double>(k + 1) * knot_distance);
  }
  for (const double u : parameters) {
    const Eigen::Vector2d tangent = derivative(u, 1);
    if (!(tangent.norm() > 1e-6)) {
      throw std::invalid_argument(fmt::format("SmoothCurve: stands still at parameter {}", u));
    }
    const double heading = std::atan2(tangent.y(), tangent.x());
    const double before = knot_headings_rad_.empty() ? heading : knot_headings_rad_.back();
    knot_headings_rad_.push_back(before + wrap_angle(heading - before));
    knot_points_.push_back(derivative(u, 0));
  }
  arc_length_ = ArcLength(std::move(parameters), [this](double u) { return speed(u); });
  table_ = make_table();
}

std::size_t SmoothCurve::span_of(double u) const {
  const double index = std::floor(u / knot_distance_);
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(spans_.size() - 1)));
}

Eigen::Vector2d SmoothCurve::derivative(double u, int order) const {
  const std::size_t k = span_of(u);
  const double t = u / knot_distance_ - static_cast<double>(k);
  const Eigen::Vector2d value(evaluate(spans_[k].x, t, order), evaluate(spans_[k].y, t, order));
  double scale = 1.0;
  for (int i = 0; i < order; ++i) scale /= knot_distance_;
  return order == 0 ? Eigen::Vector2d(spans_[k].origin + value) : Eigen::Vector2d(scale * value);
}

CurvePoint SmoothCurve::point_at(std::size_t k, double t, double s_m) const {
  const Taylor<6> dx = first_derivative_series(spans_[k].x, t, knot_distance_);
  const Taylor<6> dy = first_derivative_series(spans_[k].y, t, knot_distance_);
  const double turned = wrap_angle(std::atan2(dy[0], dx[0]) - knot_headings_rad_[k]);
  const Eigen::Vector2d relative(evaluate(spans_[k].x, t), evaluate(spans_[k].y, t));
  return {s_m, spans_[k].origin + relative, knot_headings_rad_[k] + turned, curvatures(dx, dy)};
}

CurveTable SmoothCurve::make_table() const {
  constexpr int kPieces = 4;  // per span
  std::vector<CurvePoint> nodes;
  nodes.reserve(kPieces * spans_.size() + 1);
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const double knot = static_cast<double>(k) * knot_distance_;
    for (int i = 0; i < kPieces; ++i) {
      const double t = static_cast<double>(i) / kPieces;
      const double within =
          integrate([this](double u) { return speed(u); }, knot, knot + t * knot_distance_);
      nodes.push_back(point_at(k, t, arc_length_.stations_m()[k] + within));
    }
  }
  nodes.push_back(point_at(spans_.size() - 1, 1.0, length_m()));
  return CurveTable(nodes);
}

CurvePoint SmoothCurve::at(double s_m) const {
  CurvePoint point = table_.at(s_m);
  if (const double beyond_m = s_m - point.s_m; beyond_m != 0.0) {
    point.position +=
        beyond_m * Eigen::Vector2d(std::cos(point.heading_rad), std::sin(point.heading_rad));
    point.curvature_per_m = {};
    point.s_m = s_m;
  }
  return point;
}

std::size_t SmoothCurve::downhill(const Eigen::Vector2d& point, std::size_t knot) const {
  const auto squared = [&](std::size_t k) { return (knot_points_[k] - point).squaredNorm(); };
  while (knot + 1 < knot_points_.size() && squared(knot + 1) < squared(knot)) ++knot;
  while (knot > 0 && squared(knot - 1) < squared(knot)) --knot;
  return knot;
}

// Parameter of the foot between the neighbours of a knot that is nearer than they: Newton's method
// for (p(u) − q)·p′(u) = 0, kept in its bracket by bisection.
double SmoothCurve::foot_near(const Eigen::Vector2d& point, std::size_t knot) const {
  const auto& u_at = arc_length_.parameters();
  double low = u_at[knot == 0 ? 0 : knot - 1], high = u_at[std::min(knot + 1, u_at.size() - 1)];
  double u = u_at[knot];
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Eigen::Vector2d away = derivative(u, 0) - point, first = derivative(u, 1);
    const double slope = away.dot(first);
    (slope > 0.0 ? high : low) = u;
    const double bend = first.squaredNorm() + away.dot(derivative(u, 2));
    double next = bend > 0.0 ? u - slope / bend : low - 1.0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - u) < 1e-12 * (1.0 + std::abs(u))) return next;
    u = next;
  }
  return u;
}

// The foot may lie beside any knot that is nearer than its neighbours and, within a span, not
// farther than the nearest one.
double SmoothCurve::nearest_foot(const Eigen::Vector2d& point) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& knot : knot_points_) {
    nearest_m = std::min(nearest_m, (knot - point).norm());
  }
  double best_u = 0.0, best_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < knot_points_.size(); ++k) {
    const double distance_m = (knot_points_[k] - point).norm();
    if (distance_m > nearest_m + 2.0 * knot_distance_ || downhill(point, k) != k) continue;
    const double u = foot_near(point, k);
    const double foot_m = (derivative(u, 0) - point).norm();
    if (foot_m < best_m) {
      best_m = foot_m;
      best_u = u;
    }
  }
  return best_u;
}

LinePosition SmoothCurve::beside(const Eigen::Vector2d& point, double u) const {
  const auto speed_at = [this](double v) { return speed(v); };
  const Eigen::Vector2d tangent = derivative(u, 1).normalized();
  const Eigen::Vector2d away = point - derivative(u, 0);
  double s_m = arc_length_.station_at(u, speed_at);
  const double along_m = away.dot(tangent);
  const bool before = u <= arc_length_.parameters().front() + 1e-9 && along_m < 0.0;
  const bool past = u >= arc_length_.parameters().back() - 1e-9 && along_m > 0.0;
  if (before || past) s_m += along_m;
  return {s_m, cross(tangent, away)};
}

LinePosition SmoothCurve::project(const Eigen::Vector2d& point,
                                  std::optional<double> near_s_m) const {
  if (!near_s_m) return beside(point, nearest_foot(point));
  const auto& stations = knots_m();
  const auto after = std::upper_bound(stations.begin(), stations.end() - 1, *near_s_m);
  const auto knot = static_cast<std::size_t>(after - stations.begin());
  return beside(point, foot_near(point, downhill(point, knot)));
}

}  // namespace roadbed::geometry::curves
