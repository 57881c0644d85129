#include "roadbed/geometry/motion/region_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

/// Stars around random places, united: rings with sharp corners, holes and touching points.
std::vector<Polygon> random_region(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-20.0, 20.0), radius(1.0, 12.0);
  std::vector<Polygon> stars;
  for (int i = 0; i < 12; ++i) {
    const Vector2d middle(place(random), place(random));
    Ring ring;
    for (int k = 0; k < 14; ++k) {
      const double angle = 2.0 * M_PI * k / 14.0;
      ring.emplace_back(middle + radius(random) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    stars.push_back({ring, {}});
  }
  return unite(stars, 0.0);
}

bool is_in(const std::vector<Polygon>& polygons, const Vector2d& point) {
  return std::ranges::any_of(polygons, [&](const Polygon& p) { return contains(p, point); });
}

template <typename Visit>
void visit_edges(const std::vector<Polygon>& polygons, const Visit& visit) {
  const auto of = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  for (const Polygon& polygon : polygons) {
    of(polygon.outer);
    for (const Ring& hole : polygon.holes) of(hole);
  }
}

/// By walking along every edge in small steps.
double walked_m(const std::vector<Polygon>& polygons, const Rectangle& shape) {
  double least_m = std::numeric_limits<double>::infinity();
  visit_edges(polygons, [&](const Vector2d& a, const Vector2d& b) {
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.01);
    for (int k = 0; k <= steps; ++k) {
      least_m = std::min(least_m, distance_m(shape, a + (b - a) * k / steps));
    }
  });
  return least_m;
}

TEST(RegionEdges, TellTheSideOfEveryPointAsExactTestsDo) {
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> place(-35.0, 35.0);
  int inside = 0;
  for (int map = 0; map < 20; ++map) {
    const std::vector<Polygon> polygons = random_region(random);
    const RegionEdges edges(polygons);
    for (int i = 0; i < 5000; ++i) {
      const Vector2d point(place(random), place(random));
      const bool is_inside = is_in(polygons, point);
      ASSERT_EQ(edges.contains(point), is_inside);
      const auto nearest = edges.nearest(point, 1e9);
      ASSERT_TRUE(nearest);
      if (nearest->distance_m > 1e-7) {
        ASSERT_EQ(nearest->is_inside, is_inside);
      }
      inside += is_inside ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 10'000);
}

TEST(RegionEdges, AreAsFarFromARectangleAsAWalkAlongThem) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-25.0, 25.0), half(0.0, 2.5), angle(-4.0, 4.0);
  int apart = 0;
  for (int map = 0; map < 5; ++map) {
    const std::vector<Polygon> polygons = random_region(random);
    const RegionEdges edges(polygons);
    for (int i = 0; i < 60; ++i) {
      const double turn = angle(random);
      const Rectangle shape{.centre = {place(random), place(random)},
                            .axis = {std::cos(turn), std::sin(turn)},
                            .half_length_m = half(random),
                            .half_width_m = half(random)};
      const auto nearest = edges.nearest(shape, 1e9);
      ASSERT_TRUE(nearest);
      EXPECT_NEAR(nearest->distance_m, walked_m(polygons, shape), 5e-3);
      if (nearest->distance_m < 1e-3) continue;
      ++apart;
      EXPECT_EQ(nearest->is_inside, is_in(polygons, shape.centre));
      EXPECT_NEAR((nearest->on_edge - nearest->on_shape).norm(), nearest->distance_m, 1e-12);
      EXPECT_FALSE(edges.nearest(shape, nearest->distance_m * (1.0 - 1e-12)));
      EXPECT_TRUE(edges.nearest(shape, nearest->distance_m * (1.0 + 1e-9)));
    }
  }
  EXPECT_GT(apart, 100);
}

TEST(RegionEdges, OfPolygonsThatTouchAtACornerTellTheSide) {
  const std::vector<Polygon> polygons{{box_ring({0, 0}, {1, 1}), {}},
                                      {box_ring({1, 1}, {2, 2}), {}}};
  const RegionEdges edges(polygons);
  for (const Vector2d& off :
       {Vector2d(-0.1, -0.1), Vector2d(0.1, 0.1), Vector2d(-0.1, 0.1), Vector2d(0.1, -0.1)}) {
    const Vector2d point = Vector2d(1, 1) + off;
    EXPECT_EQ(edges.nearest(point, 5.0)->is_inside, off.x() * off.y() > 0.0);
  }
}

TEST(RegionEdges, OfNothingAreNowhere) {
  const RegionEdges edges(std::vector<Polygon>{});
  EXPECT_FALSE(edges.contains({0, 0}));
  EXPECT_FALSE(edges.nearest(Vector2d(0, 0), 1e9));
}

}  // namespace
}  // namespace roadbed::geometry
