#include "roadbed/geometry/primitives/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/polyline.h"

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
