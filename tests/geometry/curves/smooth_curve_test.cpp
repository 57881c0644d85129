#include "roadbed/geometry/curves/smooth_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace roadbed::geometry {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points winding_points(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn(-0.15, 0.15), step(0.8, 1.2);
  std::vector<Eigen::Vector2d> points{{4000.0, -2500.0}};
  double heading = 0.0, rate = 0.0;
  for (int i = 0; i < 80; ++i) {
    rate = 0.8 * rate + turn(random);
    heading += rate;
    points.push_back(points.back() +
                     step(random) * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  return points;
}

SmoothCurve winding_curve(unsigned seed) { return SmoothCurve(winding_points(seed), 1.0); }

// De Boor's algorithm on the knots … −1, 0, 1, …: the spline of this degree at t, whose first span
// is [0, 1].
Eigen::Vector2d de_boor(const Points& control, int degree, double t) {
  const int span = std::min(static_cast<int>(t), static_cast<int>(control.size()) - degree - 1);
  Points d(control.begin() + span, control.begin() + span + degree + 1);
  for (int r = 1; r <= degree; ++r) {
    for (int j = degree; j >= r; --j) {
      const double knot = span - degree + j;
      const double fraction = (t - knot) / (degree - r + 1);
      d[static_cast<std::size_t>(j)] = (1.0 - fraction) * d[static_cast<std::size_t>(j - 1)] +
                                       fraction * d[static_cast<std::size_t>(j)];
    }
  }
  return d.back();
}

// Control points of the derivative.
Points differences(const Points& control) {
  Points result;
  for (std::size_t i = 0; i + 1 < control.size(); ++i)
    result.push_back(control[i + 1] - control[i]);
  return result;
}

// Stencils of fourth order for the first derivative.
template <typename Function>
double slope(const Function& f, double s, double h) {
  return (8.0 * (f(s + h) - f(s - h)) - (f(s + 2.0 * h) - f(s - 2.0 * h))) / (12.0 * h);
}

TEST(SmoothCurve, HasUnitSpeedAndTurnsByItsCurvature) {
  const SmoothCurve curve = winding_curve(20261121);
  for (double s = 1.0; s < curve.length_m() - 1.0; s += 0.0917) {
    const double x = slope([&](double at) { return curve.at(at).position.x(); }, s, 1e-3);
    const double y = slope([&](double at) { return curve.at(at).position.y(); }, s, 1e-3);
    const CurvePoint point = curve.at(s);
    EXPECT_NEAR(std::hypot(x, y), 1.0, 1e-8) << "at " << s << " m";
    EXPECT_NEAR(x, std::cos(point.heading_rad), 1e-8);
    EXPECT_NEAR(y, std::sin(point.heading_rad), 1e-8);
    const double turning = slope([&](double at) { return curve.at(at).heading_rad; }, s, 1e-3);
    EXPECT_NEAR(point.curvature_per_m[0], turning, 1e-8);
  }
}

TEST(SmoothCurve, EachCurvatureDerivativeIsTheSlopeOfTheOneBefore) {
  const SmoothCurve curve = winding_curve(7);
  for (std::size_t order = 1; order < 5; ++order) {
    for (double s = 1.0; s < curve.length_m() - 1.0; s += 0.0917) {
      const auto before = [&](double at) { return curve.at(at).curvature_per_m[order - 1]; };
      EXPECT_NEAR(curve.at(s).curvature_per_m[order], slope(before, s, 1e-3),
                  order < 4 ? 2e-5 : 5e-4)
          << "order " << order << " at " << s << " m";
    }
  }
}

TEST(SmoothCurve, NothingUpToTheFourthDerivativeOfCurvatureJumpsAtKnots) {
  const SmoothCurve curve = winding_curve(3);
  const double h = 1e-9;
  for (std::size_t k = 1; k + 1 < curve.knots_m().size(); ++k) {
    const CurvePoint before = curve.at(curve.knots_m()[k] - h),
                     after = curve.at(curve.knots_m()[k] + h);
    EXPECT_NEAR((after.position - before.position).norm(), 2.0 * h, 2e-12);
    EXPECT_NEAR(after.heading_rad, before.heading_rad, 1e-8);
    const double tolerances[] = {1e-8, 1e-8, 1e-8, 1e-7, 1e-6};
    for (std::size_t order = 0; order < 5; ++order) {
      EXPECT_NEAR(after.curvature_per_m[order], before.curvature_per_m[order], tolerances[order])
          << "order " << order << " at knot " << k;
    }
  }
}

TEST(SmoothCurve, KeepsToTheSplineOfItsControlPoints) {
  const Points control = winding_points(12), first = differences(control),
               second = differences(first);
  const SmoothCurve curve(control, 1.0);
  for (double t = 0.003; t < static_cast<double>(control.size()) - 7.0; t += 0.0371) {
    const LinePosition foot = curve.project(de_boor(control, 7, t));
    const CurvePoint point = curve.at(foot.s_m);
    EXPECT_NEAR((point.position - de_boor(control, 7, t)).norm(), 0.0, 1e-10) << "at " << t;
    const Eigen::Vector2d p1 = de_boor(first, 6, t), p2 = de_boor(second, 5, t);
    const double curvature = (p1.x() * p2.y() - p1.y() * p2.x()) / std::pow(p1.norm(), 3.0);
    EXPECT_NEAR(point.curvature_per_m[0], curvature, 1e-10) << "at " << t;
    EXPECT_NEAR(std::remainder(point.heading_rad - std::atan2(p1.y(), p1.x()), 2.0 * M_PI), 0.0,
                1e-10);
  }
}

TEST(SmoothCurve, ControlPointsOnALineGiveThatLineAtArcLength) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 20; ++i) points.push_back({3.0 * i, 4.0 * i});
  const SmoothCurve curve(points, 5.0);
  EXPECT_NEAR(curve.length_m(), 13.0 * 5.0, 1e-9);
  for (double s = -3.0; s < 70.0; s += 0.7) {
    const CurvePoint point = curve.at(s);
    EXPECT_NEAR(point.position.x(), 9.0 + 0.6 * s, 1e-9);
    EXPECT_NEAR(point.position.y(), 12.0 + 0.8 * s, 1e-9);
    EXPECT_NEAR(point.curvature_per_m[0], 0.0, 1e-12);
  }
}

TEST(SmoothCurve, ProjectionIsTheNearestOfManyPoints) {
  std::mt19937 random(20261121);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const SmoothCurve curve = winding_curve(seed);
    Points fine;
    for (int i = 0; i <= 20000; ++i)
      fine.push_back(curve.at(curve.length_m() * i / 20000).position);
    std::uniform_real_distribution<double> station(1.0, curve.length_m() - 1.0),
        offset(-12.0, 12.0);
    for (int trial = 0; trial < 100; ++trial) {
      const Eigen::Vector2d point =
          curve.at(station(random)).position + Eigen::Vector2d(offset(random), offset(random));
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const auto& at : fine) nearest_m = std::min(nearest_m, (at - point).norm());
      const LinePosition foot = curve.project(point);
      EXPECT_NEAR((curve.at(std::clamp(foot.s_m, 0.0, curve.length_m())).position - point).norm(),
                  nearest_m, 1e-3);
    }
  }
}

TEST(SmoothCurve, ProjectionUndoesAnOffsetAlsoBeforeAndPastItsEnds) {
  const SmoothCurve curve = winding_curve(11);
  for (double s = -5.0; s < curve.length_m() + 5.0; s += 0.31) {
    for (const double d : {-0.8, 0.0, 0.5}) {
      const CurvePoint point = curve.at(s);
      const Eigen::Vector2d left(-std::sin(point.heading_rad), std::cos(point.heading_rad));
      const LinePosition foot = curve.project(point.position + d * left, s + 1.7);
      EXPECT_NEAR(foot.s_m, s, 1e-8);
      EXPECT_NEAR(foot.d_m, d, 1e-8);
    }
  }
}

TEST(SmoothCurve, RefusesTooFewControlPointsAndACurveThatStandsStill) {
  const std::vector<Eigen::Vector2d> seven(7, Eigen::Vector2d(0, 0));
  EXPECT_THROW(SmoothCurve(seven, 1.0), std::invalid_argument);
  const std::vector<Eigen::Vector2d> still(9, Eigen::Vector2d(2, 1));
  EXPECT_THROW(SmoothCurve(still, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
