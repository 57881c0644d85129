#include "roadbed/map/occupancy/objects/fitted_rectangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "roadbed/tests/support/made_street.h"

namespace roadbed::map {
namespace {

using geometry::Rectangle;

// Two sides that meet in a corner, as a sensor sees a car.
std::vector<Eigen::Vector2d> corner_of(const Rectangle& box) {
  const auto corners = box.corners();
  std::vector<Eigen::Vector2d> points;
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 2)}) {
    for (int k = 0; k <= 40; ++k) {
      const double fraction = k / 40.0;
      points.push_back((1.0 - fraction) * corners[static_cast<std::size_t>(from)] +
                       fraction * corners[static_cast<std::size_t>(to)]);
    }
  }
  return points;
}

double between_axes_rad(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double quarter = 0.5 * std::numbers::pi;
  const double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  return std::abs(angle - quarter * std::round(angle / quarter));
}

TEST(FittedRectangle, LiesAlongTheSidesThatAreSeenAtACorner) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-50, 50), turn(0, 2 * std::numbers::pi);
  for (int i = 0; i < 200; ++i) {
    const Rectangle truth = tests::rectangle(place(random), place(random), turn(random), 4.5, 1.8);
    const Rectangle fitted = fitted_rectangle(corner_of(truth));
    EXPECT_LT(between_axes_rad(truth.axis, fitted.axis), 0.03) << i;
    EXPECT_NEAR(2.0 * fitted.half_length_m, 4.5, 0.1) << i;
    EXPECT_NEAR(2.0 * fitted.half_width_m, 1.8, 0.15) << i;
    EXPECT_NEAR((fitted.centre - truth.centre).norm(), 0.0, 0.1) << i;
  }
}

TEST(FittedRectangle, HoldsAllPointsAndItsLengthIsTheLongerSide) {
  std::mt19937 random(8);
  std::normal_distribution<double> place(0, 3);
  for (int i = 0; i < 100; ++i) {
    std::vector<Eigen::Vector2d> points;
    for (int k = 0; k < 1 + i; ++k) points.emplace_back(place(random), 0.3 * place(random));
    const Rectangle fitted = fitted_rectangle(points);
    EXPECT_GE(fitted.half_length_m, fitted.half_width_m);
    for (const Eigen::Vector2d& point : points) {
      EXPECT_LT(geometry::distance_m(fitted, point), 1e-9) << i;
    }
  }
}

TEST(FittedRectangle, OfOnePointIsThatPoint) {
  const Rectangle fitted = fitted_rectangle(std::vector<Eigen::Vector2d>{{3.0, 4.0}});
  EXPECT_EQ(fitted.centre, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(fitted.half_length_m, 0.0);
}

}  // namespace
}  // namespace roadbed::map
