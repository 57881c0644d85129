#include "roadbed/geometry/curves/spline_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace roadbed::geometry {
namespace {

std::vector<Eigen::Vector2d> winding_points() {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> turn(-0.9, 0.9), step(0.8, 6.0);
  std::vector<Eigen::Vector2d> points{{0.0, 0.0}};
  double heading = 0.0;
  for (int i = 0; i < 40; ++i) {
    heading += turn(random);
    points.push_back(points.back() +
                     step(random) * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  return points;
}

TEST(SplineCurve, GoesThroughItsPoints) {
  const auto points = winding_points();
  const SplineCurve curve = SplineCurve::through(points);
  ASSERT_EQ(curve.knots().size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR((curve.at(curve.station_at(curve.knots()[i])) - points[i]).norm(), 0.0, 1e-9);
  }
}

TEST(SplineCurve, StationIsTheLengthOfFineChords) {
  const SplineCurve curve = SplineCurve::through(winding_points());
  double chords_m = 0.0;
  Eigen::Vector2d before = curve.at(0.0);
  const int count = 100000;
  for (int i = 1; i <= count; ++i) {
    const double s = curve.length_m() * i / count;
    const Eigen::Vector2d point = curve.at(s);
    chords_m += (point - before).norm();
    before = point;
    if (i % 10000 == 0) {
      EXPECT_NEAR(chords_m, s, 1e-6);
    }
  }
}

TEST(SplineCurve, ResampledPointsAreOneStepApartAlongTheCurve) {
  const SplineCurve curve = SplineCurve::through(winding_points());
  const auto points = curve.resample(0.01);
  const double step = curve.length_m() / static_cast<double>(points.size() - 1);
  EXPECT_LE(step, 0.01);
  EXPECT_GT(step, 0.00999);
  for (std::size_t i = 1; i < points.size(); ++i) {
    ASSERT_NEAR((points[i] - points[i - 1]).norm(), step, 1e-6);  // chord: step³κ²/24 shorter
  }
}

TEST(SplineCurve, CurvatureIsTheTurningOfTheTangent) {
  const SplineCurve curve = SplineCurve::through(winding_points());
  const double h = 1e-5;
  for (double s = 1.0; s < curve.length_m() - 1.0; s += 0.37) {
    const Eigen::Vector2d a = curve.tangent(s - h), b = curve.tangent(s + h);
    const double turned = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    EXPECT_NEAR(curve.curvature_per_m(s), turned / (2.0 * h), 2e-4) << "at " << s << " m";
    const Eigen::Vector2d chord = (curve.at(s + h) - curve.at(s - h)) / (2.0 * h);
    EXPECT_NEAR((chord - curve.tangent(s)).norm(), 0.0, 1e-6);
  }
}

TEST(SplineCurve, ClosedCurveThroughACircleIsNearlyOne) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 36; ++i) {
    const double angle = i * std::numbers::pi / 18.0;
    points.push_back({20.0 * std::cos(angle), 20.0 * std::sin(angle)});
  }
  const SplineCurve curve = SplineCurve::closed_through(points);
  EXPECT_NEAR(curve.length_m(), 40.0 * std::numbers::pi, 1e-3);
  EXPECT_NEAR((curve.at(0.0) - curve.at(curve.length_m())).norm(), 0.0, 1e-12);
  EXPECT_NEAR((curve.tangent(0.0) - curve.tangent(curve.length_m())).norm(), 0.0, 1e-12);
  for (double s = 0.0; s < curve.length_m(); s += 0.1) {
    EXPECT_NEAR(curve.curvature_per_m(s), 0.05, 2e-4);
  }
}

TEST(SplineCurve, ClampedEndsHaveTheGivenDirections) {
  const std::vector<Eigen::Vector2d> points{{0, 0}, {10, 1}, {20, 0}};
  const SplineCurve curve =
      SplineCurve::through(points, Eigen::Vector2d(0.0, 2.0), Eigen::Vector2d(-3.0, -3.0));
  EXPECT_NEAR((curve.tangent(0.0) - Eigen::Vector2d(0, 1)).norm(), 0.0, 1e-12);
  const double root = std::sqrt(0.5);
  EXPECT_NEAR((curve.tangent(curve.length_m()) - Eigen::Vector2d(-root, -root)).norm(), 0.0, 1e-9);
}

TEST(SplineCurve, DropsRepeatedPointsAndRefusesTooFew) {
  const std::vector<Eigen::Vector2d> points{{0, 0}, {0, 0}, {5, 0}, {5, 0}, {10, 0}};
  EXPECT_EQ(SplineCurve::through(points).knots().size(), 3U);
  const std::vector<Eigen::Vector2d> one{{1, 1}, {1, 1}};
  EXPECT_THROW(SplineCurve::through(one), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector2d> broken{{1, 1}, {nan, 1}};
  EXPECT_THROW(SplineCurve::through(broken), std::invalid_argument);
  EXPECT_THROW(SplineCurve::through(points).resample(0.0), std::invalid_argument);
}

TEST(SplineCurve, ResamplesToThePointsOfItsStations) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> turn(-0.6, 0.6), gap(0.8, 12.0);
  std::vector<Eigen::Vector2d> points{{10.0, -3.0}};
  double heading = 0.3;
  for (int i = 0; i < 30; ++i) {
    heading += turn(random);
    points.push_back(points.back() +
                     gap(random) * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  std::vector<Eigen::Vector2d> ring;
  for (int i = 0; i < 30; ++i) {
    const double angle = 0.2 * i, radius_m = 30.0 + 5.0 * turn(random);
    ring.push_back(radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  for (const SplineCurve& curve :
       {SplineCurve::through(points), SplineCurve::closed_through(ring)}) {
    for (const double step_m : {0.01, 0.37, 40.0}) {
      const auto resampled = curve.resample(step_m);
      const double apart_m = curve.length_m() / static_cast<double>(resampled.size() - 1);
      EXPECT_LE(apart_m, step_m * (1.0 + 1e-9));
      for (std::size_t i = 0; i < resampled.size(); ++i) {
        const Eigen::Vector2d expected = curve.at(apart_m * static_cast<double>(i));
        ASSERT_LE((resampled[i] - expected).norm(), 1e-6) << "point " << i;
      }
    }
  }
}

}  // namespace
}  // namespace roadbed::geometry
