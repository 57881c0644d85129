#include "roadbed/geometry/primitives/polyline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

TEST(Simplify, KeepsWithinTheToleranceOfEveryPoint) {
  std::vector<Vector2d> circle;
  for (int i = 0; i <= 2000; ++i) {
    circle.emplace_back(10 * std::cos(i * 0.003), 10 * std::sin(i * 0.003));
  }
  const auto simple = simplify(circle, 0.01);
  EXPECT_LT(simple.size(),
            140u);  // a chord of 0.01 m error spans 0.09 rad; halving may cut it once more
  EXPECT_GT(simple.size(), 60u);
  EXPECT_EQ(simple.front(), circle.front());
  EXPECT_EQ(simple.back(), circle.back());
  const Polyline line(simple);
  for (const Vector2d& point : circle) EXPECT_LE(std::abs(line.project(point).d_m), 0.01 + 1e-12);
}

TEST(Simplify, KeepsClosedLinesOpenedUp) {
  const std::vector<Vector2d> ring = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}};
  EXPECT_EQ(simplify(ring, 0.1), ring);
}

TEST(Simplify, KeepsNoisyLinesWithinTheToleranceOfEveryPoint) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> noise_m(-0.02, 0.02);
  for (int round = 0; round < 50; ++round) {
    std::vector<Vector2d> line;
    for (int i = 0; i < 300; ++i) {
      line.emplace_back(0.1 * i, std::sin(0.05 * i) + noise_m(random));
    }
    const auto simple = simplify(line, 0.05);
    const Polyline shown(simple);
    for (const Vector2d& point : line) {
      EXPECT_LE((shown.at(shown.project(point).s_m) - point).norm(), 0.05 + 1e-12);
    }
    EXPECT_LT(simple.size(), line.size() / 3);
  }
}

// Halving takes one end off at a time there: work by the square of their number, without a limit.
TEST(Simplify, KeepsEveryPointOfALongZigzag) {
  std::vector<Vector2d> zigzag;
  for (int i = 0; i < 100'000; ++i) zigzag.emplace_back(1e-3 * i, 0.5 * (i % 2));
  EXPECT_EQ(simplify(zigzag, 0.01), zigzag);
}

TEST(Simplify, LeavesTheEndsOfAStraightLine) {
  EXPECT_EQ(simplify(std::vector<Vector2d>{{0, 0}, {1, 1}, {2, 2}, {5, 5}}, 1e-9).size(), 2U);
}

TEST(Simplify, KeepsALineThatComesBackToItsStart) {
  EXPECT_EQ(simplify(std::vector<Vector2d>{{0, 0}, {3, 0}, {0, 0}}, 0.1).size(), 3U);
}

TEST(Simplify, LeavesShortLinesAlone) {
  const std::vector<Vector2d> line = {{0, 0}, {4, 0}};
  EXPECT_EQ(simplify(line, 100.0), line);
  EXPECT_TRUE(simplify({}, 1.0).empty());
}

TEST(Simplify, RefusesTolerancesThatAreNotNumbers) {
  EXPECT_THROW(simplify({}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(simplify({}, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
