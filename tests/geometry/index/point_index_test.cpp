#include "roadbed/geometry/index/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace roadbed::geometry {
namespace {

TEST(PointIndex, FindsWhatALinearScanFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-100.0, 100.0);
  std::vector<Eigen::Vector2d> points(2000);
  for (auto& point : points) point = {place(random), place(random)};
  const PointIndex index(points);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d query(1.5 * place(random), 1.5 * place(random));
    double nearest = 1e300;
    for (const auto& point : points) nearest = std::min(nearest, (point - query).norm());
    const auto found = index.nearest(query);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance_m, nearest, 1e-12);
    EXPECT_NEAR((points[found->index] - query).norm(), nearest, 1e-12);
  }
}

TEST(PointIndex, OfNoPointsFindsNothing) { EXPECT_FALSE(PointIndex({}).nearest({0, 0})); }

TEST(PointIndex, OfEqualPointsFindsTheFirst) {
  std::vector<Eigen::Vector2d> points(100, {3.0, 4.0});
  points.front() = {9.0, 9.0};
  points.back() = {1.0, 0.0};
  const PointIndex index(points);
  EXPECT_EQ(index.nearest({4.0, 4.0})->index, 1u);
  EXPECT_NEAR(index.nearest({4.0, 4.0})->distance_m, 1.0, 1e-12);
  EXPECT_EQ(index.nearest({0.0, 0.0})->index, 99u);
}

TEST(PointIndex, RefusesPointsThatAreNotFinite) {
  EXPECT_THROW(PointIndex({{0.0, std::nan("")}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
