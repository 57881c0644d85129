#include "roadbed/geometry/spline_curve.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace roadbed::geometry {
namespace {

constexpr double kSamePoint_m = 1e-6;
constexpr int kPanelsPerPiece = 4;  // of the quadrature: a chord's speed may vary much

// Points without repetition, and the length of the chords up to each.
struct Chords {
  std::vector<double> parameter, x, y;

  void add(const Eigen::Vector2d& point) {
    if (!point.allFinite()) throw std::invalid_argument("SplineCurve: a point is not finite");
    double length = 0.0;
    if (!x.empty()) {
      length = std::hypot(point.x() - x.back(), point.y() - y.back());
      if (length < kSamePoint_m) return;
    }
    parameter.push_back(parameter.empty() ? 0.0 : parameter.back() + length);
    x.push_back(point.x());
    y.push_back(point.y());
  }
};

Chords chords_of(std::span<const Eigen::Vector2d> points, std::size_t least) {
  Chords chords;
  for (const Eigen::Vector2d& point : points) chords.add(point);
  if (chords.x.size() < least) {
    throw std::invalid_argument(fmt::format(
        "SplineCurve: needs at least {} distinct points, got {}", least, chords.x.size()));
  }
  return chords;
}

std::vector<double> subdivided(const std::vector<double>& knots) {
  std::vector<double> finer;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    for (int j = 0; j < kPanelsPerPiece; ++j) {
      finer.push_back(knots[i] + (knots[i + 1] - knots[i]) * j / kPanelsPerPiece);
    }
  }
  finer.push_back(knots.back());
  return finer;
}

}  // namespace

SplineCurve::SplineCurve(CubicSpline x, CubicSpline y)
    : x_(std::move(x)),
      y_(std::move(y)),
      arc_length_(subdivided(x_.knots()), [this](double u) { return derivative(u, 1).norm(); }) {}

SplineCurve SplineCurve::through(std::span<const Eigen::Vector2d> points,
                                 const std::optional<Eigen::Vector2d>& first_direction,
                                 const std::optional<Eigen::Vector2d>& last_direction) {
  const Chords c = chords_of(points, 2);
  const auto slope = [](const std::optional<Eigen::Vector2d>& direction, Eigen::Index axis) {
    return direction ? std::optional(direction->normalized()(axis)) : std::nullopt;
  };
  return SplineCurve(
      CubicSpline::clamped(c.parameter, c.x, slope(first_direction, 0), slope(last_direction, 0)),
      CubicSpline::clamped(c.parameter, c.y, slope(first_direction, 1), slope(last_direction, 1)));
}

SplineCurve SplineCurve::closed_through(std::span<const Eigen::Vector2d> points) {
  Chords c = chords_of(points, 3);
  c.add({c.x.front(), c.y.front()});
  return SplineCurve(CubicSpline::periodic(c.parameter, c.x),
                     CubicSpline::periodic(c.parameter, c.y));
}

Eigen::Vector2d SplineCurve::derivative(double parameter, int order) const {
  return {x_.derivative(parameter, order), y_.derivative(parameter, order)};
}

double SplineCurve::station_at(double parameter) const {
  return arc_length_.station_at(parameter, [this](double u) { return derivative(u, 1).norm(); });
}

double SplineCurve::parameter_at(double s_m) const {
  return arc_length_.parameter_at(s_m, [this](double u) { return derivative(u, 1).norm(); });
}

Eigen::Vector2d SplineCurve::at(double s_m) const { return derivative(parameter_at(s_m), 0); }

Eigen::Vector2d SplineCurve::tangent(double s_m) const {
  return derivative(parameter_at(s_m), 1).normalized();
}

double SplineCurve::curvature_per_m(double s_m) const {
  const double u = parameter_at(s_m);
  const Eigen::Vector2d first = derivative(u, 1), second = derivative(u, 2);
  return (first.x() * second.y() - first.y() * second.x()) / std::pow(first.norm(), 3);
}

std::vector<Eigen::Vector2d> SplineCurve::resample(double step_m) const {
  if (!(step_m > 0.0)) {
    throw std::invalid_argument(
        fmt::format("SplineCurve: the step must be positive, got {} m", step_m));
  }
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(length_m() / step_m - 1e-9)));
  std::vector<Eigen::Vector2d> points;
  points.reserve(steps + 1);
  for (std::size_t i = 0; i <= steps; ++i) {
    points.push_back(at(length_m() * static_cast<double>(i) / static_cast<double>(steps)));
  }
  return points;
}

}  // namespace roadbed::geometry
