#include "roadbed/map/lanelet2/centreline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace roadbed::map::lanelet2 {
namespace {

Line3 arc(double radius_m, int points, double phase = 0.0) {
  Line3 line;
  for (int i = 0; i < points; ++i) {
    const double inner = i == 0 || i == points - 1 ? 0.0 : phase;
    const double angle = 1.2 * (i + inner) / (points - 1);
    line.emplace_back(radius_m * std::sin(angle), -radius_m * std::cos(angle), 0.1 * i);
  }
  return line;
}

TEST(Centreline, LiesMidwayBetweenConcentricArcs) {
  // Left turn: the left border is the inner one; vertices of the borders are not opposite.
  const Centreline centre = centreline_between(arc(20.0, 13, 0.4), arc(24.0, 17));
  for (const Eigen::Vector3d& point : centre.points) {
    EXPECT_NEAR(point.head<2>().norm(), 22.0, 0.06);
  }
  EXPECT_NEAR((centre.points.front().head<2>() - Eigen::Vector2d(0, -22)).norm(), 0.0, 1e-12);
}

TEST(Centreline, StationsOfBordersGrowFromNothingToTheLength) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> noise(-0.4, 0.4);
  for (int round = 0; round < 200; ++round) {
    Line3 left, right;
    for (int i = 0; i < 5 + round % 9; ++i) left.emplace_back(2.0 * i, 3.0 + noise(random), 0.0);
    for (int i = 0; i < 3 + round % 5; ++i) right.emplace_back(4.0 * i, noise(random), 0.0);
    const Centreline centre = centreline_between(left, right);
    double length_m = 0.0;
    for (std::size_t i = 1; i < centre.points.size(); ++i) {
      length_m += (centre.points[i] - centre.points[i - 1]).head<2>().norm();
    }
    for (const auto& stations : {centre.left_station_m, centre.right_station_m}) {
      EXPECT_EQ(stations.front(), 0.0);
      EXPECT_NEAR(stations.back(), length_m, 1e-9);
      EXPECT_TRUE(std::is_sorted(stations.begin(), stations.end()));
    }
    EXPECT_EQ(centre.left_station_m.size(), left.size());
    EXPECT_EQ(centre.right_station_m.size(), right.size());
  }
}

TEST(Centreline, EndsBetweenTheEndsOfTheBordersEvenIfTheseCross) {
  const Line3 left = {{0, 3, 0}, {5, 3, 0}, {10, 0, 0}}, right = {{0, 0, 0}, {5, 4, 0}, {10, 3, 0}};
  const Centreline centre = centreline_between(left, right);
  EXPECT_EQ(centre.points.front(), Eigen::Vector3d(0, 1.5, 0));
  EXPECT_EQ(centre.points.back(), Eigen::Vector3d(10, 1.5, 0));
}

TEST(Centreline, ALongBorderCostsNoMoreThanItsLength) {
  Line3 left, right;
  for (int i = 0; i < 20'000; ++i) {
    left.emplace_back(0.1 * i, 3.0, 0.0);
    right.emplace_back(0.1 * i, 0.0, 0.0);
  }
  EXPECT_NEAR(centreline_between(left, right).left_station_m.back(), 1999.9, 1e-6);
}

/// Coordinates that a shift takes no digit from; points on a coarse grid, for many rungs that are
/// equally near or touch a border.
TEST(Centreline, IsTheSameWhereverTheOriginIs) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> step(0, 3), aside(-1, 1);
  for (int i = 0; i < 300; ++i) {
    Line3 lines[2];
    for (int k = 0; k < 2; ++k) {
      Eigen::Vector3d at(0, k == 0 ? 1.3 : 0, 0);
      for (int vertex = 0; vertex < 12; ++vertex) {
        lines[k].push_back({std::ldexp(std::round(std::ldexp(at.x(), 20)), -20),
                            std::ldexp(std::round(std::ldexp(at.y(), 20)), -20), 0});
        at += Eigen::Vector3d(0.1 + 0.7 * step(random), 0.3 * aside(random), 0);
      }
    }
    const Centreline here = centreline_between(lines[0], lines[1]);
    for (Line3& line : lines) {
      for (Eigen::Vector3d& point : line) point += Eigen::Vector3d(457'000, 5'428'000, 0);
    }
    const Centreline there = centreline_between(lines[0], lines[1]);
    EXPECT_EQ(here.left_station_m, there.left_station_m) << i;
    EXPECT_EQ(here.right_station_m, there.right_station_m) << i;
    ASSERT_EQ(here.points.size(), there.points.size()) << i;
  }
}

TEST(Centreline, AnOwnOneGivesTheBordersItsStations) {
  const Line3 left = {{0, 3, 0}, {4, 3, 0}, {10, 3, 0}}, right = {{0, 0, 0}, {10, 0, 0}};
  const Centreline centre = centreline_along({{0, 1, 0}, {10, 1, 0}}, left, right);
  EXPECT_EQ(centre.left_station_m, (std::vector{0.0, 4.0, 10.0}));
  EXPECT_EQ(centre.right_station_m, (std::vector{0.0, 10.0}));
}

}  // namespace
}  // namespace roadbed::map::lanelet2
