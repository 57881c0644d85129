#include "roadbed/map/edit/clipping/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/edit/clipping/region_part.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

geometry::Ring star() {
  geometry::Ring ring;
  for (int i = 0; i < 10; ++i) {
    const double angle = 0.62831853 * i, radius = i % 2 == 0 ? 10.0 : 4.0;
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return ring;
}

TEST(Region, ContainsWhatItsRingContains) {
  const Region region({star()});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-12.0, 12.0);
  for (int i = 0; i < 2000; ++i) {
    const Vector2d point(place(random), place(random));
    EXPECT_EQ(region.contains(point), geometry::contains(star(), point)) << point.transpose();
  }
}

TEST(Region, ContainsEachOfManyPointsAsItContainsOne) {
  geometry::Ring spikes;  // that pass corners of the grid of points, and run along its lines
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.10471975511966 * i, radius = i % 2 == 0 ? 11.0 : 1.5;
    spikes.emplace_back(std::round(4 * radius * std::cos(angle)) / 4,
                        std::round(4 * radius * std::sin(angle)) / 4);
  }
  const geometry::Ring bow = {{-6, -6}, {6, 6}, {6, -6}, {-6, 6}};  // crosses itself and the others
  const Region region({spikes, bow, geometry::box_ring({-3, -3}, {3, 3})});
  std::vector<Vector2d> points;
  for (int y = -48; y <= 48; ++y) {
    for (int x = -48; x <= 48; ++x) points.emplace_back(0.25 * (y % 2 == 0 ? x : -x), 0.25 * y);
  }
  const std::vector<bool> inside = contains_each(region, points);
  ASSERT_EQ(inside.size(), points.size());
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(inside[i], region.contains(points[i])) << points[i].transpose();
    count += inside[i] ? 1 : 0;
  }
  EXPECT_GT(count, 1000);
  EXPECT_TRUE(contains_each(region, {}).empty());
  EXPECT_EQ(contains_each(region, std::vector{Vector2d(-6, -6)}), std::vector{true});
}

/// Of a square and, where its disc is on the border, of its quarters, down to points.
void expect_same_sides(const Region& region, RegionDescent& descent, const Vector2d& middle,
                       double half_m, std::size_t& asked) {
  const double radius_m = half_m < 0.05 ? 0.0 : half_m * std::sqrt(2.0);
  const Region::Side side = region.side_of_disc(middle, radius_m);
  ++asked;
  ASSERT_EQ(descent.side_of_disc(middle, radius_m), side) << middle.transpose() << ' ' << radius_m;
  if (side != Region::Side::border || radius_m == 0.0) return;
  for (const Vector2d& to : {Vector2d(-1, -1), Vector2d(-1, 1), Vector2d(1, -1), Vector2d(1, 1)}) {
    expect_same_sides(region, descent, middle + 0.5 * half_m * to, 0.5 * half_m, asked);
  }
}

TEST(RegionDescent, KnowsTheSidesThatTheRegionKnows) {
  std::vector<geometry::Ring> strips{star()};
  for (double y = -9.0; y < 9.0; y += 0.5) {
    strips.push_back({{-8.0, y}, {9.0, y + 0.3}, {9.0, y + 0.4}, {-8.0, y + 0.2}});
  }
  const Region region(std::move(strips));
  RegionDescent descent(region);
  std::size_t asked = 0;
  expect_same_sides(region, descent, {0.25, -0.5}, 16.0, asked);
  expect_same_sides(region, descent, {-3.0, 2.0}, 4.0, asked);
  EXPECT_GT(asked, 10'000u);
}

TEST(Region, IsNotWhereAHoleIs) {
  const Region region({geometry::box_ring({0, 0}, {10, 10}), geometry::box_ring({4, 4}, {6, 6})});
  EXPECT_TRUE(region.contains({1, 1}));
  EXPECT_FALSE(region.contains({5, 5}));
  EXPECT_TRUE(region.contains({4, 5})) << "edges are inside";
}

TEST(Region, IsCrossedWhereInsideBegins) {
  const Region region({star()});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-12.0, 12.0);
  for (int i = 0; i < 500; ++i) {
    const Vector2d from(place(random), place(random)), to(place(random), place(random));
    bool inside = region.contains(from);
    double before = 0.0;
    for (const double at : region.crossings(from, to)) {
      EXPECT_EQ(region.contains(from + 0.5 * (before + at) * (to - from)), inside);
      inside = !inside;
      before = at;
    }
    EXPECT_EQ(region.contains(to), inside);
  }
}

TEST(Region, KnowsTheSideOfADiscOnlyWhereNoEdgeIsNear) {
  const Region region({geometry::box_ring({0, 0}, {10, 10})});
  EXPECT_EQ(region.side_of_disc({5, 5}, 4.9), Region::Side::inside);
  EXPECT_EQ(region.side_of_disc({5, 5}, 5.1), Region::Side::border);
  EXPECT_EQ(region.side_of_disc({15, 5}, 4.9), Region::Side::outside);
  EXPECT_EQ(region.side_of_disc({15, 5}, 5.1), Region::Side::border);
}

TEST(Region, AroundALineHoldsWhatIsNearerAndNothingMuchFarther) {
  const std::vector<Vector2d> line = {{0, 0}, {50, 0}, {50, 80}};
  const Region region = region_around(line, 10.0);
  const geometry::Polyline polyline(line);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-20.0, 100.0);
  for (int i = 0; i < 2000; ++i) {
    const Vector2d point(place(random), place(random));
    const double away_m = std::abs(polyline.project(point).d_m);
    if (away_m > 9.99 && away_m < 10.04) continue;
    EXPECT_EQ(region.contains(point), away_m < 10.0) << point.transpose();
  }
}

TEST(Region, NeedsRingsOfThreePoints) {
  EXPECT_THROW(Region(std::vector<geometry::Ring>{}), std::invalid_argument);
  EXPECT_THROW(Region({{{0, 0}, {1, 1}}}), std::invalid_argument);
  EXPECT_THROW(region_around({}, 1.0), std::invalid_argument);
  EXPECT_THROW(region_around({{0, 0}, {1, 0}}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
