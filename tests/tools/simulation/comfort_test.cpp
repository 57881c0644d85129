#include "roadbed/tools/simulation/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace roadbed::tools {
namespace {

const std::vector<double> kValues{0, 1, 3, 2, 5, 8, 6, 7, 9, 4, 2, 1, 0, 3, 5, 6, 8, 7};

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-8) << i;
}

// The expected numbers are those of scipy.signal.savgol_filter.
TEST(Comfort, SmoothsAsSciPyOverAnEvenWindow) {
  expect_near(savitzky_golay(kValues, 0.1, 8, 2, 0),
              {-0.333333333, 1.19047619, 2.571428571, 3.80952381, 5.40625, 6.9375, 7.84375, 7.0625,
               5.53125, 3.6875, 1.71875, 0.8125, 1.78125, 3.5625, 4.119047619, 5.357142857,
               6.761904762, 8.333333333});
}

TEST(Comfort, DifferentiatesAsSciPy) {
  expect_near(savitzky_golay(kValues, 0.1, 15, 2, 1),
              {14.323529412, 12.348739496, 10.37394958, 8.399159664, 6.424369748, 4.449579832,
               2.474789916, 0.5, 0.0, 0.071428571, 0.214285714, 1.200064641, 2.185843568,
               3.171622495, 4.157401422, 5.143180349, 6.128959276, 7.114738203});
}

TEST(Comfort, TakesSecondDerivativesAsSciPy) {
  expect_near(
      savitzky_golay(kValues, 0.1, 5, 3, 2),
      {-285.714285714, -135.714285714, 14.285714286, 85.714285714, -28.571428571, -128.571428571,
       14.285714286, -71.428571429, -185.714285714, -42.857142857, 128.571428571, 142.857142857,
       142.857142857, 42.857142857, -42.857142857, -71.428571429, -171.428571429, -271.428571429});
}

TEST(Comfort, RefusesAnOrderThatTheWindowCannotFit) {
  EXPECT_THROW(savitzky_golay(kValues, 0.1, 3, 3, 0), std::invalid_argument);
  EXPECT_THROW(savitzky_golay(kValues, 0.1, 5, 2, 3), std::invalid_argument);
}

/// Steady driving on a circle.
geometry::Trajectory circle(double speed_mps, double curvature_per_m) {
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i < 40; ++i) {
    rows.push_back({.t_s = 0.1 * i,
                    .heading_rad = 0.1 * i * speed_mps * curvature_per_m,
                    .speed_mps = speed_mps,
                    .curvature_per_m = curvature_per_m});
  }
  return geometry::Trajectory(std::move(rows));
}

TEST(Comfort, SteadyCircleHasItsCentripetalAccelerationAndNoJerk) {
  const Comfort comfort = comfort_of(circle(10.0, -0.04));
  EXPECT_NEAR(comfort.most_lateral_mps2, 4.0, 1e-9);
  EXPECT_NEAR(comfort.most_yaw_rate_radps, 0.4, 1e-9);
  EXPECT_NEAR(comfort.most_yaw_acceleration_radps2, 0.0, 1e-9);
  EXPECT_NEAR(comfort.most_jerk_mps3, 0.0, 1e-9);
  EXPECT_TRUE(comfort.is_comfortable());
  EXPECT_FALSE(comfort_of(circle(10.0, -0.05)).is_comfortable());
}

/// A drive in which nothing is smooth.
geometry::Trajectory rough_drive() {
  std::vector<geometry::TrajectoryPoint> rows;
  double heading = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.1 * i, speed = 9.0 + 1.1 * std::sin(0.6 * t);
    const double curvature = 0.03 * std::sin(0.8 * t) + 0.004 * ((i * 53) % 7 - 3) / 3.0;
    rows.push_back({.t_s = t,
                    .heading_rad = heading,
                    .speed_mps = speed,
                    .acceleration_mps2 = 1.2 * std::sin(0.9 * t) - 0.7 * std::cos(2.3 * t) +
                                         0.25 * ((i * 37) % 11 - 5) / 5.0,
                    .curvature_per_m = curvature});
    heading += 0.1 * speed * curvature;
  }
  return geometry::Trajectory(std::move(rows));
}

// What scipy.signal.savgol_filter (SciPy 1.x) makes of the same signals with nuPlan's windows and
// orders: accelerations (8, 2); jerks of the smoothed accelerations (15, 2, first derivative);
// heading (5, 2, first) and (5, 3, second); delta = 0.1.
TEST(Comfort, EachExtremeIsThatOfNuPlansFiltersInSciPy) {
  const Comfort comfort = comfort_of(rough_drive());
  EXPECT_NEAR(comfort.least_longitudinal_mps2, -1.9183807140049594, 1e-9);
  EXPECT_NEAR(comfort.most_longitudinal_mps2, 1.8636170334831044, 1e-9);
  EXPECT_NEAR(comfort.most_lateral_mps2, 3.08978813312283, 1e-9);
  EXPECT_NEAR(comfort.most_yaw_rate_radps, 0.3105854801235438, 1e-9);
  EXPECT_NEAR(comfort.most_yaw_acceleration_radps2, 0.3586588963091071, 1e-9);
  EXPECT_NEAR(comfort.most_longitudinal_jerk_mps3, 3.294821844594028, 1e-9);
  EXPECT_NEAR(comfort.most_jerk_mps3, 2.1133051689721074, 1e-9);
}

}  // namespace
}  // namespace roadbed::tools
