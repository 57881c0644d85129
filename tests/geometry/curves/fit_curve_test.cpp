#include "roadbed/geometry/curves/fit_curve.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/geometry/curves/spline_problem.h"

namespace roadbed::geometry {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Straight, arc, straight.
Points turn_of(double radius_m, double angle_rad, double leg_m) {
  Points points;
  const double step = 0.1, arc_m = radius_m * angle_rad;
  Eigen::Vector2d at(0, 0);
  double heading = 0.0;
  for (double s = 0.0; s < 2.0 * leg_m + arc_m; s += step) {
    points.push_back(at);
    const double turning = s > leg_m && s < leg_m + arc_m ? step / radius_m : 0.0;
    at += step * Eigen::Vector2d(std::cos(heading + turning / 2), std::sin(heading + turning / 2));
    heading += turning;
  }
  return points;
}

double move_of(const Points& points, const SmoothCurve& curve) {
  double largest = 0.0;
  for (const auto& point : points) largest = std::max(largest, std::abs(curve.project(point).d_m));
  return largest;
}

TEST(BandMatrix, SolvesAsADenseMatrixDoes) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  const std::size_t size = 30, bandwidth = 5;
  BandMatrix band(size, bandwidth);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(30, 30);
  std::vector<double> right;
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = row < bandwidth ? 0 : row - bandwidth; column <= row; ++column) {
      const double entry = row == column ? 12.0 : value(random);
      band.at(row, column) = entry;
      dense(static_cast<int>(row), static_cast<int>(column)) = entry;
      dense(static_cast<int>(column), static_cast<int>(row)) = entry;
    }
    right.push_back(value(random));
  }
  const Eigen::VectorXd expected =
      dense.fullPivLu().solve(Eigen::Map<Eigen::VectorXd>(right.data(), 30));
  const auto solution = BandMatrix::solve(band, right).value();
  for (std::size_t i = 0; i < size; ++i)
    EXPECT_NEAR(solution[i], expected(static_cast<int>(i)), 1e-13);
  band.at(3, 3) = -1.0;
  EXPECT_FALSE(BandMatrix::solve(band, right));
}

TEST(FitCurve, KeepsAStraightLine) {
  const FittedCurve fitted = fit_curve(Points{{1, 2}, {61, 82}});
  EXPECT_NEAR(fitted.curve.length_m(), 100.0, 1e-6);
  EXPECT_NEAR(fitted.largest_move_m, 0.0, 1e-7);
  EXPECT_NEAR(fitted.peak_curvature_per_m, 0.0, 1e-7);
  EXPECT_NEAR((fitted.curve.at(0.0).position - Eigen::Vector2d(1, 2)).norm(), 0.0, 1e-6);
}

TEST(FitCurve, FollowsAWideArc) {
  const FittedCurve fitted = fit_curve(turn_of(100.0, 1.5, 0.0));
  EXPECT_LT(fitted.largest_move_m, 0.01);
  for (double s = 10.0; s < 140.0; s += 0.5) {
    EXPECT_NEAR(fitted.curve.at(s).curvature_per_m[0], 0.01, 1e-4);
  }
}

TEST(FitCurve, RightTurnsOfStreetCornersStayNearAndSteerable) {
  for (const double radius_m : {5.0, 6.0, 8.0, 12.0}) {
    const Points points = turn_of(radius_m, std::numbers::pi / 2.0, 20.0);
    const FittedCurve fitted = fit_curve(points);
    EXPECT_LE(move_of(points, fitted.curve), 0.301) << radius_m;
    EXPECT_LE(fitted.peak_curvature_per_m, 0.2) << radius_m;
    for (double s = 0.0; s < fitted.curve.length_m(); s += 0.1) {
      EXPECT_LE(std::abs(fitted.curve.at(s).curvature_per_m[1]), 0.035) << radius_m;
    }
  }
}

TEST(FitCurve, BeginsAndEndsBesideItsFirstAndLastPointInABend) {
  const Points points = turn_of(5.0, 2.0, 0.0);
  const FittedCurve fitted = fit_curve(points);
  EXPECT_LE(move_of(points, fitted.curve), 0.301);
  EXPECT_LE(fitted.largest_move_m, 0.301);
  EXPECT_NEAR(fitted.curve.project(points.front()).s_m, 0.0, 0.25);
  EXPECT_NEAR(fitted.curve.project(points.back()).s_m, fitted.curve.length_m(), 0.25);
}

TEST(FitCurve, KeepsATighterToleranceWhereAskedTo) {
  const Points points = turn_of(6.0, std::numbers::pi / 2.0, 20.0);
  for (const double tolerance_m : {0.2, 0.1, 0.05}) {
    const FittedCurve fitted = fit_curve(points, {.tolerance_m = tolerance_m});
    EXPECT_LE(move_of(points, fitted.curve), tolerance_m + 1e-3);
  }
}

TEST(FitCurve, TakesNoiseAway) {
  std::mt19937 random(20261121);
  std::normal_distribution<double> noise(0.0, 0.05);
  Points points = turn_of(40.0, 1.0, 30.0);
  for (auto& point : points) point += Eigen::Vector2d(noise(random), noise(random));
  const FittedCurve fitted = fit_curve(points, {.tolerance_m = 0.5});
  EXPECT_LT(fitted.peak_curvature_per_m, 0.05);  // 0.025 without noise
  EXPECT_LT(move_of(turn_of(40.0, 1.0, 30.0), fitted.curve), 0.06);
}

TEST(FitCurve, AKinkAGapAndAShortLineStaySmooth) {
  EXPECT_LE(fit_curve(Points{{0, 0}, {30, 0}, {60, 0.6}}).peak_curvature_per_m, 0.01);
  EXPECT_LE(fit_curve(Points{{0, 0}, {30, 0}, {30.01, 0.05}, {60, 0.05}}).peak_curvature_per_m,
            0.01);
  EXPECT_NEAR(fit_curve(Points{{0, 0}, {0.3, 0}}).curve.length_m(), 0.3, 1e-6);
}

TEST(FitCurve, RefusesOnePointAndOptionsOutOfRange) {
  EXPECT_THROW(fit_curve(Points{{1, 1}}), std::invalid_argument);
  EXPECT_THROW(fit_curve(Points{{1, 1}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW(fit_curve(Points{{1, 1}, {9, 1}}, {.scale_m = 9.0}), std::invalid_argument);
  EXPECT_THROW(fit_curve(Points{{1, 1}, {9, 1}}, {.tolerance_m = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
