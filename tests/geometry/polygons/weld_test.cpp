#include "roadbed/geometry/polygons/ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/tests/geometry/polygons/ring_distance.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

Ring random_ring(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(0.0, 3.0);
  Ring ring;
  for (int i = 0; i < 7; ++i) ring.emplace_back(coordinate(random), coordinate(random));
  return ring;
}

TEST(Weld, GivesNearPointsOfTwoRingsTheSameCoordinates) {
  const auto rings =
      weld({{{0, 0}, {1, 0}, {1, 1}}, {{1.0004, 0.0003}, {2, 0}, {2, 1}}}, 1e-3).rings;
  EXPECT_EQ(rings[0][1], Vector2d(1, 0));
  EXPECT_EQ(rings[1][0], Vector2d(1, 0));
}

TEST(Weld, SaysHowFarItMovedWhat) {
  const Welded points = weld({{{0, 0}, {1, 0}, {1, 1}}, {{1.0004, 0.0003}, {2, 0}, {2, 1}}}, 1e-3);
  EXPECT_EQ(points.moved_points, 1u);
  EXPECT_NEAR(points.most_moved_m, 5e-4, 1e-12);
  const Welded edge = weld({{{10, 0}, {0, 0}, {0, -5}}, {{3, 0.0007}, {7, 3}, {3, 3}}}, 1e-3);
  EXPECT_EQ(edge.moved_points, 1u);
  EXPECT_NEAR(edge.most_moved_m, 7e-4, 1e-12);
  EXPECT_EQ(weld({{{0, 0}, {1, 0}, {1, 1}}, {{1, 0}, {2, 0}, {2, 1}}}, 1e-3).moved_points, 0u);
}

TEST(Weld, GivesAnEdgeThePointsThatItPassesNearlyInItsDirection) {
  const auto rings =
      weld({{{10, 0}, {0, 0}, {0, -5}}, {{3, 0.0005}, {7, -0.0005}, {7, 3}, {3, 3}}}, 1e-3).rings;
  const Ring expected = {{10, 0}, {7, -0.0005}, {3, 0.0005}, {0, 0}, {0, -5}};
  EXPECT_EQ(rings[0], expected);
}

// Between edges of centimetres and of thousands of kilometres; some points lie just beside edges.
Ring uneven_ring(std::mt19937& random) {
  std::uniform_real_distribution<double> power(-1.0, 6.0), angle(0.0, 6.28), fraction(0.1, 0.9);
  Ring ring;
  for (int i = 0; i < 60; ++i) {
    const double radius_m = std::pow(10.0, power(random)), at = angle(random);
    ring.emplace_back(radius_m * std::cos(at), radius_m * std::sin(at));
  }
  const Ring corners = ring;
  for (std::size_t i = 0; i + 1 < corners.size(); i += 3) {
    const Vector2d along = corners[i + 1] - corners[i];
    const Vector2d left = Vector2d(-along.y(), along.x()).normalized();
    ring.emplace_back(corners[i] + fraction(random) * along + (i % 2 == 0 ? 9e-4 : 1.1e-3) * left);
  }
  return ring;
}

// What edges pass, by looking at every point. @pre no two points are within the distance.
Ring split_slowly(const Ring& ring, double weld_m) {
  Ring result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d a = ring[i], along = ring[(i + 1) % ring.size()] - a;
    result.push_back(a);
    std::vector<std::pair<double, Vector2d>> passed;
    for (const Vector2d& point : ring) {
      const double fraction = (point - a).dot(along) / along.squaredNorm();
      const bool is_end = point == a || point == ring[(i + 1) % ring.size()];
      if (is_end || fraction <= 0.0 || fraction >= 1.0) continue;
      if ((a + fraction * along - point).norm() <= weld_m) passed.emplace_back(fraction, point);
    }
    std::ranges::sort(passed, {}, [](const auto& one) { return one.first; });
    for (const auto& [fraction, point] : passed) result.push_back(point);
  }
  return result;
}

TEST(Weld, FindsThePassedPointsHoweverUnevenlyTheyLie) {
  std::mt19937 random(5);
  std::size_t added = 0;
  for (int i = 0; i < 200; ++i) {
    const Ring ring = uneven_ring(random);
    const Ring welded = weld({ring}, 1e-3).rings.front();
    ASSERT_EQ(welded, split_slowly(ring, 1e-3)) << i;
    added += welded.size() - ring.size();
  }
  EXPECT_GT(added, 1'500u);
}

TEST(Weld, WithZeroOnlyDropsRepeatedPoints) {
  const auto rings =
      weld({{{0, 0}, {0, 0}, {1, 0}, {1, 1e-9}, {0, 0}}, {{0, 0}, {1, 1}}}, 0.0).rings;
  EXPECT_EQ(rings[0], (Ring{{0, 0}, {1, 0}, {1, 1e-9}}));
  EXPECT_TRUE(rings[1].empty());
}

TEST(Weld, LeavesNoTwoDifferentPointsTooNear) {
  constexpr double kWeld = 0.05;
  std::mt19937 random(20261121);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Ring> before = {random_ring(random), random_ring(random),
                                      random_ring(random)};
    const auto after = weld(before, kWeld).rings;
    for (const Ring& one : after) {
      for (const Ring& other : after) {
        for (const Vector2d& a : one) {
          for (const Vector2d& b : other) EXPECT_TRUE(a == b || (a - b).norm() > kWeld);
        }
      }
    }
  }
}

TEST(Weld, MovesNoPointFartherThanTheDistance) {
  constexpr double kWeld = 0.05;
  std::mt19937 random(20261122);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Ring> before = {random_ring(random), random_ring(random)};
    const auto after = weld(before, kWeld).rings;
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (const Vector2d& point : before[k]) {
        EXPECT_LE(distance_to_ring_m(after[k], point), kWeld + 1e-12);
      }
      for (const Vector2d& point : after[k]) {
        EXPECT_LE(distance_to_ring_m(before[k], point), 2 * kWeld + 1e-12);
      }
    }
  }
}

TEST(Weld, DoesNotDependOnTheOrderOfTheRings) {
  std::mt19937 random(20261123);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Ring> rings = {random_ring(random), random_ring(random), random_ring(random)};
    const auto forwards = weld(rings, 0.1).rings;
    const auto backwards = weld({rings.rbegin(), rings.rend()}, 0.1).rings;
    EXPECT_EQ(forwards, std::vector<Ring>(backwards.rbegin(), backwards.rend()));
  }
}

TEST(Weld, RefusesDistancesThatAreNegativeOrNotNumbers) {
  EXPECT_THROW(weld({}, -1e-3), std::invalid_argument);
  EXPECT_THROW(weld({}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
