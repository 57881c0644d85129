#include "roadbed/geometry/curves/quintic_bezier.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "roadbed/geometry/curves/quadrature.h"

namespace roadbed::geometry::inline curves {
namespace {

constexpr int kDegree = 5;
constexpr int kPanels = 16;  // of the length's quadrature

// Σⱼ C(n,j) (1−t)^(n−j) t^j Pⱼ, n = points − 1.
Eigen::Vector2d bernstein_sum(const std::vector<Eigen::Vector2d>& points, double t) {
  const auto n = static_cast<int>(points.size()) - 1;
  Eigen::Vector2d sum(0.0, 0.0);
  double binomial = 1.0;
  for (int j = 0; j <= n; ++j) {
    sum +=
        binomial * std::pow(1.0 - t, n - j) * std::pow(t, j) * points[static_cast<std::size_t>(j)];
    binomial *= static_cast<double>(n - j) / (j + 1);
  }
  return sum;
}

void check_leg(double leg_m, const CornerGaps& gaps) {
  if (!(gaps.first_m > 0.0) || !(gaps.second_m > 0.0) || !(gaps.corner_m > 0.0)) {
    throw std::invalid_argument(
        fmt::format("QuinticBezier: gaps must be positive, got {}, {}, {} m", gaps.first_m,
                    gaps.second_m, gaps.corner_m));
  }
  if (!(leg_m >= gaps.total_m() * (1.0 - 1e-12))) {
    throw std::invalid_argument(
        fmt::format("QuinticBezier: gaps of {} m do not fit a leg of {} m", gaps.total_m(), leg_m));
  }
}

// Control point i = 0, 1, 2 of a leg that runs along a heading. B″ = 20 (P2 − 2 P1 + P0) is across
// it, and κ = B′ × B″ / |B′|³ with B′ = 5 (P1 − P0).
Eigen::Vector2d on_leg(const CurvePoint& end, double gap_m, int i) {
  const Eigen::Vector2d along(std::cos(end.heading_rad), std::sin(end.heading_rad));
  const Eigen::Vector2d left(-along.y(), along.x());
  const double across_m = i == 2 ? 1.25 * end.curvature_per_m[0] * gap_m * gap_m : 0.0;
  return end.position + i * gap_m * along + across_m * left;
}

}  // namespace

CornerGaps scaled_to(const CornerGaps& gaps, double total_m) {
  const double scale = total_m / gaps.total_m();
  return {scale * gaps.first_m, scale * gaps.second_m, scale * gaps.corner_m};
}

QuinticBezier QuinticBezier::corner(const Eigen::Vector2d& w1, const Eigen::Vector2d& w2,
                                    const Eigen::Vector2d& w3, const CornerGaps& gaps) {
  check_leg((w2 - w1).norm(), gaps);
  check_leg((w3 - w2).norm(), gaps);
  const Eigen::Vector2d back = (w1 - w2).normalized(), ahead = (w3 - w2).normalized();
  const double near_m = gaps.corner_m, middle_m = near_m + gaps.second_m, far_m = gaps.total_m();
  return QuinticBezier({w2 + far_m * back, w2 + middle_m * back, w2 + near_m * back,
                        w2 + near_m * ahead, w2 + middle_m * ahead, w2 + far_m * ahead});
}

QuinticBezier QuinticBezier::joining(const CurvePoint& from, double from_gap_m,
                                     const CurvePoint& to, double to_gap_m) {
  if (!(from_gap_m > 0.0) || !(to_gap_m > 0.0)) {
    throw std::invalid_argument(
        fmt::format("QuinticBezier: gaps must be positive, got {} and {} m", from_gap_m, to_gap_m));
  }
  return QuinticBezier({on_leg(from, from_gap_m, 0), on_leg(from, from_gap_m, 1),
                        on_leg(from, from_gap_m, 2), on_leg(to, -to_gap_m, 2),
                        on_leg(to, -to_gap_m, 1), on_leg(to, -to_gap_m, 0)});
}

Eigen::Vector2d QuinticBezier::derivative(double t, int order) const {
  if (order < 0) throw std::invalid_argument("QuinticBezier: negative order of a derivative");
  if (order > kDegree) return {0.0, 0.0};
  std::vector<Eigen::Vector2d> points(control_points_.begin(), control_points_.end());
  for (int k = 0; k < order; ++k) {  // the hodograph: n times the differences
    for (std::size_t j = 0; j + 1 < points.size(); ++j) {
      points[j] = (kDegree - k) * (points[j + 1] - points[j]);
    }
    points.pop_back();
  }
  return bernstein_sum(points, t);
}

double QuinticBezier::curvature_per_m(double t) const {
  const Eigen::Vector2d first = derivative(t, 1), second = derivative(t, 2);
  return (first.x() * second.y() - first.y() * second.x()) / std::pow(first.norm(), 3);
}

double QuinticBezier::length_m() const {
  double length_m = 0.0;
  const auto speed = [this](double t) { return derivative(t, 1).norm(); };
  for (int i = 0; i < kPanels; ++i) {
    length_m +=
        integrate(speed, static_cast<double>(i) / kPanels, static_cast<double>(i + 1) / kPanels);
  }
  return length_m;
}

}  // namespace roadbed::geometry::curves
