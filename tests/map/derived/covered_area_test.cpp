#include "roadbed/map/derived/covered_area.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map {
namespace {

using geometry::Ring;

Ring rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

std::vector<GroupedRing> all_of(const std::vector<Ring>& rings,
                                std::uint32_t group = GroupedRing::kNoGroup) {
  std::vector<GroupedRing> grouped;
  for (const Ring& ring : rings) grouped.push_back({&ring, group});
  return grouped;
}

/// A bent strip of 3 m, as a lane is, turned and moved at random.
Ring bent_strip(std::mt19937& random) {
  std::uniform_real_distribution<double> place_m(-40.0, 40.0), turn(-3.1, 3.1), bend(-0.04, 0.04);
  const Eigen::Vector2d start(place_m(random), place_m(random));
  const double heading = turn(random), curvature = bend(random);
  Ring ring;
  Eigen::Vector2d at = start;
  std::vector<Eigen::Vector2d> left;
  for (int i = 0; i <= 20; ++i) {
    const double angle = heading + curvature * 2.0 * i;
    const Eigen::Vector2d normal(-std::sin(angle), std::cos(angle));
    ring.push_back(at - 1.5 * normal);
    left.push_back(at + 1.5 * normal);
    at += 2.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

double united_m2(const std::vector<Ring>& rings) {
  std::vector<geometry::Polygon> polygons;
  for (const Ring& ring : rings) polygons.push_back({ring, {}});
  double sum_m2 = 0.0;
  for (const geometry::Polygon& polygon : geometry::unite_and_report(polygons, 0.0).polygons) {
    sum_m2 += geometry::area_m2(polygon);
  }
  return sum_m2;
}

TEST(CoveredArea, OfRandomStripsIsThatOfTheirExactUnion) {
  std::mt19937 random(20261122);
  for (int round = 0; round < 20; ++round) {
    std::vector<Ring> rings;
    for (int i = 0; i < 4 + 4 * round; ++i) rings.push_back(bent_strip(random));
    const auto area = covered_area(all_of(rings));
    ASSERT_TRUE(area);
    EXPECT_NEAR(area->all_m2, united_m2(rings), 1e-6);
    EXPECT_EQ(area->groups_m2, 0.0);
  }
}

TEST(CoveredArea, OfGroupsIsTheSumOfEachAlone) {
  std::mt19937 random(20261122);
  std::vector<Ring> rings;
  for (int i = 0; i < 30; ++i) rings.push_back(bent_strip(random));
  std::vector<GroupedRing> grouped;
  std::vector<std::vector<Ring>> of_group(3);
  for (std::uint32_t i = 0; i < rings.size(); ++i) {
    const std::uint32_t group = i % 4;
    grouped.push_back({&rings[i], group == 3 ? GroupedRing::kNoGroup : 100 * group});
    if (group < 3) of_group[group].push_back(rings[i]);
  }
  double expected_m2 = 0.0;
  for (const std::vector<Ring>& group : of_group) expected_m2 += united_m2(group);
  const auto area = covered_area(grouped);
  ASSERT_TRUE(area);
  EXPECT_NEAR(area->groups_m2, expected_m2, 1e-6);
  EXPECT_NEAR(area->all_m2, united_m2(rings), 1e-6);
}

TEST(CoveredArea, CountsEqualTouchingAndNestedRingsOnce) {
  const std::vector<Ring> rings{rectangle({0, 0}, {10, 10}),  rectangle({0, 0}, {10, 10}),
                                rectangle({10, 0}, {20, 10}), rectangle({0, 10}, {20, 12}),
                                rectangle({2, 2}, {3, 3}),    {{0, 0}, {0, 10}, {10, 10}}};
  const auto area = covered_area(all_of(rings, 7));
  ASSERT_TRUE(area);
  EXPECT_NEAR(area->all_m2, 240.0, 1e-9);
  EXPECT_NEAR(area->groups_m2, 240.0, 1e-9);
  EXPECT_EQ(covered_area({})->all_m2, 0.0);
}

TEST(CoveredArea, OfARingThatCrossesItselfIsThatOfItsOddWindingsAloneOrNot) {
  std::vector<Ring> rings{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}};
  EXPECT_NEAR(covered_area(all_of(rings))->all_m2, 2.0, 1e-9);
  rings.push_back(rectangle({0.5, -5}, {0.6, -4}));
  EXPECT_NEAR(covered_area(all_of(rings))->all_m2, 2.1, 1e-9);
}

TEST(CoveredArea, IsTheSameFarOutAndTurned) {
  std::mt19937 random(20261122);
  std::vector<Ring> rings;
  for (int i = 0; i < 40; ++i) rings.push_back(bent_strip(random));
  std::vector<Ring> moved = rings;
  const Eigen::Rotation2Dd turn(0.7);
  for (Ring& ring : moved) {
    for (Eigen::Vector2d& point : ring) point = turn * point + Eigen::Vector2d(2e5, -3e5);
  }
  EXPECT_NEAR(covered_area(all_of(moved))->all_m2, covered_area(all_of(rings))->all_m2, 1e-5);
}

TEST(CoveredArea, OfARowOfThousandsIsAddedUpInSteps) {
  std::vector<Ring> rings;
  for (int i = 0; i < 20'000; ++i) rings.push_back(rectangle({5.0 * i, 0.0}, {5.0 * i + 6.0, 3.0}));
  EXPECT_NEAR(covered_area(all_of(rings))->all_m2, 3.0 * (5.0 * 20'000 + 1.0), 1e-6);
}

TEST(CoveredArea, IsNotAskedOfThousandsOfCrossingRings) {
  std::vector<Ring> rings;  // every one crosses every other
  for (int i = 0; i < 3000; ++i) {
    const double angle = M_PI * i / 3000.0;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    rings.push_back(
        {-1e3 * along - across, 1e3 * along - across, 1e3 * along + across, -1e3 * along + across});
  }
  EXPECT_FALSE(covered_area(all_of(rings)));
}

}  // namespace
}  // namespace roadbed::map
