#include "roadbed/geometry/curves/spline_curve.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/curves/quadrature.h"

namespace roadbed::geometry::inline curves {
namespace {

constexpr double kSamePoint_m = 1e-6;
constexpr int kPanelsPerPiece = 4;  // of the quadrature: a chord's speed may vary much

constexpr double kArcPiece_m = 0.25;

// A place on the curve with its derivatives by arc length.
struct ArcNode {
  double s_m;
  Eigen::Vector2d position, tangent, bend;
};

// The curve between two places without a knot between them: the polynomial of degree five in arc
// length that has their positions and first two derivatives. A quarter of a metre apart, it is
// off by h⁶/(46,080 r⁵): 5 nm at a radius of 1 m.
class ArcPiece {
 public:
  ArcPiece(const ArcNode& from, const ArcNode& to) : from_m_(from.s_m) {
    const double h = to.s_m - from.s_m;
    const Eigen::Vector2d slope = h * from.tangent, bend = 0.5 * h * h * from.bend;
    const Eigen::Vector2d missing = to.position - (from.position + slope + bend);
    const Eigen::Vector2d missing_slope = h * to.tangent - (slope + 2.0 * bend);
    const Eigen::Vector2d missing_bend = h * h * to.bend - 2.0 * bend;
    c_ = {from.position,
          slope,
          bend,
          10.0 * missing - 4.0 * missing_slope + 0.5 * missing_bend,
          -15.0 * missing + 7.0 * missing_slope - missing_bend,
          6.0 * missing - 3.0 * missing_slope + 0.5 * missing_bend};
    per_m_ = 1.0 / h;
  }

  Eigen::Vector2d at(double s_m) const {
    const double t = (s_m - from_m_) * per_m_;
    return c_[0] + t * (c_[1] + t * (c_[2] + t * (c_[3] + t * (c_[4] + t * c_[5]))));
  }

 private:
  double from_m_, per_m_ = 0.0;
  std::array<Eigen::Vector2d, 6> c_;
};

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
  const auto station_m = [&](std::size_t i) {
    return length_m() * static_cast<double>(i) / static_cast<double>(steps);
  };
  std::vector<Eigen::Vector2d> points;
  points.reserve(steps + 1);
  const auto emit_below = [&](const ArcPiece& piece, double end_m) {
    while (points.size() < steps && station_m(points.size()) < end_m) {
      points.push_back(piece.at(station_m(points.size())));
    }
  };
  const auto node_at = [&](double u, double s_m) {
    const Eigen::Vector2d first = derivative(u, 1), second = derivative(u, 2);
    const double squared = first.squaredNorm(), speed = std::sqrt(squared);
    const double curvature = (first.x() * second.y() - first.y() * second.x()) / (squared * speed);
    const Eigen::Vector2d tangent = first / speed;
    return ArcNode{s_m, derivative(u, 0), tangent,
                   curvature * Eigen::Vector2d(-tangent.y(), tangent.x())};
  };
  const auto speed = [this](double u) { return derivative(u, 1).norm(); };
  ArcNode from = node_at(knots().front(), 0.0);
  for (std::size_t i = 0; i + 1 < knots().size(); ++i) {
    const double begin = knots()[i], width = knots()[i + 1] - begin;
    const int parts = static_cast<int>(std::ceil(width / kArcPiece_m));
    for (int part = 1; part <= parts; ++part) {
      const double u0 = begin + width * (part - 1) / parts;
      const double u1 = part == parts ? knots()[i + 1] : begin + width * part / parts;
      const ArcNode to = node_at(u1, from.s_m + integrate(speed, u0, u1));
      emit_below(ArcPiece(from, to), to.s_m);
      from = to;
    }
  }
  while (points.size() <= steps) points.push_back(derivative(knots().back(), 0));
  return points;
}

}  // namespace roadbed::geometry::curves
