#include "roadbed/geometry/curves/plan_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace roadbed::geometry {
namespace {

// x = ∫ cos θ, y = ∫ sin θ with θ = k s + r s²/2, by Simpson in long double.
Pose2 integrate_heading(double k, double rate, double length_m, int n = 4000) {
  long double x = 0, y = 0;
  for (int i = 0; i <= n; ++i) {
    const long double s = static_cast<long double>(length_m) * i / n;
    const long double heading = k * s + rate * s * s / 2;
    const long double weight = (i == 0 || i == n) ? 1 : (i % 2 == 1 ? 4 : 2);
    x += weight * std::cos(heading);
    y += weight * std::sin(heading);
  }
  const long double scale = static_cast<long double>(length_m) / (3 * n);
  return {static_cast<double>(x * scale), static_cast<double>(y * scale),
          k * length_m + 0.5 * rate * length_m * length_m};
}

PlanView single(const PlanCurve& curve, double length_m) {
  return PlanView({{0.0, length_m, {}, curve}});
}

TEST(PlanView, SpiralsAndArcsAreTheIntegralOfTheirHeading) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> curvature(-0.2, 0.2), length(1.0, 120.0);
  for (int i = 0; i < 200; ++i) {
    const double k0 = curvature(random), k1 = curvature(random), length_m = length(random);
    const Pose2 spiral = single(SpiralCurve{k0, k1}, length_m).at(length_m).pose;
    const Pose2 expected = integrate_heading(k0, (k1 - k0) / length_m, length_m);
    EXPECT_NEAR((spiral.position() - expected.position()).norm(), 0.0, 1e-10);
    EXPECT_NEAR(spiral.heading_rad, expected.heading_rad, 1e-12);
    const Pose2 arc = single(ArcCurve{k0}, length_m).at(length_m).pose;
    EXPECT_NEAR((arc.position() - integrate_heading(k0, 0, length_m).position()).norm(), 0, 1e-10);
  }
}

// Turning to and fro, or hardly less at one end than at the other, forwards and back.
TEST(PlanView, SpiralsOfManyTurnsAreTheIntegralOfTheirHeading) {
  std::mt19937 random(20261201);
  std::uniform_real_distribution<double> curvature(-2.0, 2.0), exponent(-9.0, 0.5);
  for (int i = 0; i < 300; ++i) {
    const double k0 = curvature(random);
    const double k1 = k0 + std::copysign(std::pow(10.0, exponent(random)), curvature(random));
    const double s_m = i % 3 == 0 ? -20.0 : 40.0;
    const Pose2 spiral = plan_point({0.0, 40.0, {}, SpiralCurve{k0, k1}}, s_m).pose;
    const Pose2 expected = integrate_heading(k0, (k1 - k0) / 40.0, s_m, 60'000);
    EXPECT_NEAR((spiral.position() - expected.position()).norm(), 0.0, 1e-11) << k0 << ' ' << k1;
  }
}

// Editors ask for places of curves that no reader would take; sanitizers look at what comes of it.
TEST(PlanView, SpiralsOfAnyTurningAreFollowedInLimitedTime) {
  for (const double k1 : {4294967296.0, 1e300, std::nan("")}) {
    EXPECT_EQ(plan_point({0.0, 20.0, {}, SpiralCurve{0.0, k1}}, 0.0).pose.x_m == 0.0, k1 == k1);
    plan_point({0.0, 20.0, {}, SpiralCurve{0.0, k1}}, 20.0);
  }
}

TEST(PlanView, AnArcOfAlmostNoCurvatureIsAlmostALine) {
  const Pose2 pose = single(ArcCurve{1e-12}, 100.0).at(100.0).pose;
  EXPECT_NEAR(pose.x_m, 100.0, 1e-12);
  EXPECT_NEAR(pose.y_m, 0.5 * 1e-12 * 1e4, 1e-13);
}

TEST(PlanView, Poly3IsMeasuredByItsArcLength) {
  const PlanView view = single(Poly3Curve{0.0, 0.1, 0.01, -0.0002}, 60.0);
  double walked_m = 0.0;
  Eigen::Vector2d last = view.at(0.0).pose.position();
  for (int i = 1; i <= 60'000; ++i) {
    const Eigen::Vector2d next = view.at(i * 1e-3).pose.position();
    walked_m += (next - last).norm();
    last = next;
  }
  EXPECT_NEAR(walked_m, 60.0, 1e-6);
}

// Heading and curvature of every kind of curve against differences of position and heading.
TEST(PlanView, HeadingAndCurvatureAreDerivativesOfPosition) {
  const PlanCurve curves[] = {ArcCurve{-0.05}, SpiralCurve{0.01, -0.06},
                              Poly3Curve{0.0, 0.0, 0.01, -0.0002},
                              ParamPoly3Curve{{0, 30, 1, -1.2}, {0, 0.5, 4, -1.5}, 1.0}};
  for (const PlanCurve& curve : curves) {
    const PlanView view({{5.0, 30.0, {3.0, -2.0, 0.7}, curve}});
    for (double s = 6.0; s < 34.0; s += 3.1) {
      const double h = 1e-4;
      const Eigen::Vector2d step = view.at(s + h).pose.position() - view.at(s - h).pose.position();
      const double turned = view.at(s + h).pose.heading_rad - view.at(s - h).pose.heading_rad;
      EXPECT_NEAR(view.at(s).pose.heading_rad, std::atan2(step.y(), step.x()), 1e-7);
      EXPECT_NEAR(view.at(s).curvature_per_m, turned / step.norm(), 1e-6);
    }
  }
}

// No dense sample of the second derivatives may exceed the proven bounds.
TEST(PlanView, BoundsHoldEverywhere) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const double length_m = 20.0 + 15.0 * unit(random);
    const PlanCurve curves[] = {
        ArcCurve{0.1 * unit(random)}, SpiralCurve{0.1 * unit(random), 0.1 * unit(random)},
        Poly3Curve{0, 0.2 * unit(random), 0.01 * unit(random), 2e-4 * unit(random)},
        ParamPoly3Curve{{0, length_m, 2 * unit(random), unit(random)},
                        {0, unit(random), 4 * unit(random), 2 * unit(random)},
                        1.0}};
    for (const PlanCurve& curve : curves) {
      const PlanView view = single(curve, length_m);
      const double from = 0.3 * length_m, to = 0.5 * length_m;
      const PlanBounds bounds = view.bounds(from, to);
      for (double s = from + 0.01; s < to - 0.01; s += 0.05 * length_m) {
        const double h = 1e-3;
        const auto at = [&](double x) { return view.at(x).pose; };
        const Eigen::Vector2d second =
            (at(s + h).position() - 2 * at(s).position() + at(s - h).position()) / (h * h);
        const double d1 = (at(s + h).heading_rad - at(s - h).heading_rad) / (2 * h);
        const double d2 =
            (at(s + h).heading_rad - 2 * at(s).heading_rad + at(s - h).heading_rad) / (h * h);
        const Eigen::Vector2d first = (at(s + h).position() - at(s - h).position()) / (2 * h);
        const double across = (first.x() * second.y() - first.y() * second.x()) / first.norm();
        EXPECT_LE(second.norm(), bounds.second_derivative_per_m + 1e-6);
        EXPECT_LE(std::abs(across), bounds.across_per_m + 1e-6);
        EXPECT_GE(first.norm(), bounds.slowest - 1e-6);
        EXPECT_LE(std::abs(d1), bounds.heading_d1_per_m + 1e-6);
        EXPECT_LE(std::abs(d2), bounds.heading_d2_per_m2 + 1e-6);
      }
    }
  }
}

TEST(PlanView, WhereTwoPiecesMeetEachCanBeAskedFor) {
  const PlanView view({{0.0, 10.0, {}, LineCurve{}}, {10.0, 10.0, {10.0, 0.5, 0.0}, LineCurve{}}});
  EXPECT_EQ(view.at(10.0, 5.0).pose.y_m, 0.0);
  EXPECT_EQ(view.at(10.0, 15.0).pose.y_m, 0.5);
}

TEST(PlanView, RefusesPiecesWithoutLengthOrNumbers) {
  EXPECT_THROW(PlanView({}), std::invalid_argument);
  EXPECT_THROW(single(LineCurve{}, 0.0), std::invalid_argument);
  EXPECT_THROW(single(ArcCurve{std::nan("")}, 1.0), std::invalid_argument);
  EXPECT_THROW(PlanView({{5.0, 1.0, {}, LineCurve{}}, {0.0, 1.0, {}, LineCurve{}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
