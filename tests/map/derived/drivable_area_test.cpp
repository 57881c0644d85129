#include "roadbed/map/derived/drivable_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "roadbed/tests/support/bent_lanes.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

/// Distance from a point to a ring's edges by walking along them in small steps.
double walked_distance_m(const geometry::Ring& ring, const Vector2d& point) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], b = ring[(i + 1) % ring.size()];
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.005);
    for (int k = 0; k <= steps; ++k) {
      least_m = std::min(least_m, (a + (b - a) * k / steps - point).norm());
    }
  }
  return least_m;
}

TEST(DrivableArea, KnowsInsideAndTheDistanceToItsEdge) {
  std::mt19937 random(20261121);
  const RoadMap road_map = tests::random_arc_lanes(random, 40, 40.0).build();
  const DrivableArea area(road_map);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector2d point(place(random), place(random));
    bool on_lane = false;
    for (const Lane& lane : road_map.lanes()) {
      on_lane = on_lane || geometry::contains(lane.polygon, point);
    }
    double least_m = std::numeric_limits<double>::infinity();
    for (const auto& polygon : area.polygons()) {
      least_m = std::min(least_m, walked_distance_m(polygon.outer, point));
      for (const auto& hole : polygon.holes) {
        least_m = std::min(least_m, walked_distance_m(hole, point));
      }
    }
    if (least_m < 5e-3) continue;  // welding decides there
    EXPECT_EQ(area.contains(point), on_lane);
    EXPECT_NEAR(area.signed_distance_m(point), on_lane ? least_m : -least_m, 1e-3);
    inside += on_lane ? 1 : 0;
  }
  EXPECT_GT(inside, 50);
}

TEST(DrivableArea, CountsItsEdgeAsInside) {
  const DrivableArea area(tests::straight_two_lane_road(100.0).build());
  EXPECT_TRUE(area.contains({0.0, 3.5}));
  EXPECT_TRUE(area.contains({50.0, -3.5}));
  EXPECT_FALSE(area.contains({50.0, -3.5001}));
  EXPECT_NEAR(area.signed_distance_m({50.0, 0.5}), 3.0, 1e-9);
  EXPECT_NEAR(area.signed_distance_m({103.0, 7.5}), -5.0, 1e-9);
}

TEST(DrivableArea, OfNothingIsNowhere) {
  const DrivableArea area(std::vector<geometry::Polygon>{});
  EXPECT_FALSE(area.contains({0.0, 0.0}));
  EXPECT_EQ(area.signed_distance_m({0.0, 0.0}), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace roadbed::map
