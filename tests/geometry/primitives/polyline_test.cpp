#include "roadbed/geometry/primitives/polyline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace roadbed::geometry {
namespace {

Polyline random_line(std::mt19937& random) {
  std::uniform_real_distribution<double> step(-2.0, 5.0);
  std::vector<Eigen::Vector2d> points{{0.0, 0.0}};
  for (int i = 0; i < 20; ++i) {
    points.push_back(points.back() + Eigen::Vector2d(step(random), step(random) - 1.5));
  }
  return Polyline(points);
}

TEST(Polyline, ProjectionIsTheNearestOfManyPoints) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> place(-10.0, 40.0);
  for (int i = 0; i < 200; ++i) {
    const Polyline line = random_line(random);
    const Eigen::Vector2d point(place(random), place(random));
    const LinePosition found = line.project(point);
    double nearest = std::numeric_limits<double>::infinity();
    for (double s = 0.0; s <= line.length_m(); s += 0.01) {
      nearest = std::min(nearest, (line.at(s) - point).norm());
    }
    EXPECT_LE(std::abs(found.d_m), nearest + 1e-12);
    EXPECT_NEAR((line.at(found.s_m) - point).norm(), std::abs(found.d_m), 1e-9);
  }
}

TEST(Polyline, LeftIsPositive) {
  const Polyline line({{0.0, 0.0}, {10.0, 0.0}});
  EXPECT_NEAR(line.project({4.0, 2.0}).d_m, 2.0, 1e-12);
  EXPECT_NEAR(line.project({4.0, -2.0}).d_m, -2.0, 1e-12);
  EXPECT_NEAR(line.project({4.0, -2.0}).s_m, 4.0, 1e-12);
}

TEST(Polyline, RepeatedPointsHaveNoLength) {
  const Polyline line({{0.0, 0.0}, {0.0, 0.0}, {3.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}, {3.0, 4.0}});
  EXPECT_NEAR(line.length_m(), 7.0, 1e-12);
  EXPECT_NEAR(line.at(5.0).y(), 2.0, 1e-12);
  EXPECT_NEAR(line.pose_at(7.0).heading_rad, std::atan2(1.0, 0.0), 1e-12);
  EXPECT_NEAR(line.pose_at(0.0).heading_rad, 0.0, 1e-12);
}

TEST(Polyline, RefusesFewerThanTwoPointsAndNumbersThatAreNone) {
  EXPECT_THROW(Polyline({{0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(Polyline({{0.0, 0.0}, {std::nan(""), 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
