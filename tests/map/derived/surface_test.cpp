#include "roadbed/map/derived/surface.h"

#include <gtest/gtest.h>

#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;

double total_area_m2(const std::vector<Polygon>& polygons) {
  double sum_m2 = 0.0;
  for (const Polygon& polygon : polygons) sum_m2 += geometry::area_m2(polygon);
  return sum_m2;
}

bool any_contains(const std::vector<Polygon>& polygons, const Vector2d& point) {
  for (const Polygon& polygon : polygons) {
    if (geometry::contains(polygon, point)) return true;
  }
  return false;
}

TEST(RoadSurface, JoinsTheLanesOfBothDirections) {
  const RoadMap road_map = tests::straight_two_lane_road(100.0).build();
  const auto surface = road_surface(road_map, RoadId{0});
  ASSERT_EQ(surface.size(), 1u);
  EXPECT_EQ(surface[0].outer.size(), 4u);
  EXPECT_NEAR(total_area_m2(surface), 700.0, 1e-9);
}

TEST(RoadSurface, JoinsThreeLanesBesideEachOther) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  LaneId last;
  for (int i = 0; i < 3; ++i) {
    const double y = -3.0 * i;
    const LaneId id = made.add_lane(road, std::to_string(-1 - i), {{0, y}, {10, y}, {20, y + 1}},
                                    {{0, y - 3}, {10, y - 3}, {20, y - 2}});
    if (i > 0) made.put_beside(last, id);
    last = id;
  }
  const auto surface = road_surface(made.build(), road);
  ASSERT_EQ(surface.size(), 1u);
  EXPECT_EQ(surface[0].outer.size(), 6u);
  EXPECT_NEAR(total_area_m2(surface), 180.0, 1e-9);
}

TEST(RoadSurface, LeavesTheSpaceBetweenNeighboursThatShareNoBorder) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId left = made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId right = made.add_lane(road, "-2", {{0, -1}, {50, -1}}, {{0, -4}, {50, -4}});
  made.put_beside(left, right);
  const auto surface = road_surface(made.build(), road);
  EXPECT_EQ(surface.size(), 2u);
  EXPECT_NEAR(total_area_m2(surface), 300.0, 1e-9);
}

TEST(DrivableSurface, LeavesSidewalksOut) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.lane(LaneId{1}).type = LaneType::sidewalk;
  EXPECT_NEAR(total_area_m2(drivable_surface(made.build())), 350.0, 1e-9);
}

TEST(DrivableSurface, ClosesAGapBelowTheWeldDistanceBetweenRoads) {
  tests::MadeMap made;
  const RoadId one = made.add_road("1"), other = made.add_road("2");
  made.add_lane(one, "-1", {{0, 2}, {50, 2}}, {{0, -2}, {50, -2}});
  made.add_lane(other, "-1", {{50.0005, 2}, {90, 2}}, {{50.0005, -2}, {90, -2}});
  const RoadMap road_map = made.build();
  EXPECT_EQ(drivable_surface(road_map).size(), 1u);
  EXPECT_EQ(drivable_surface(road_map, {.weld_m = 1e-4}).size(), 2u);
}

TEST(JunctionSurface, CoversTheConnectingRoadsOnly) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const auto surface = junction_surface(road_map, JunctionId{0});
  EXPECT_NEAR(total_area_m2(surface), 200.0, 1e-9);
  EXPECT_TRUE(any_contains(surface, {75.0, 0.0}));
  EXPECT_FALSE(any_contains(surface, {25.0, 0.0}));
}

TEST(DrivableSurface, OfRealTownsCoversExactlyTheirDrivableLanes) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  for (const std::string town : {"Town01", "Town04", "Town10HD"}) {
    const RoadMap road_map =
        load_map(folder / "opendrive/BerkeleyLearnVerify+Scenic" / (town + ".xodr"));
    const auto surface = drivable_surface(road_map);
    for (const Polygon& polygon : surface) {
      EXPECT_TRUE(geometry::is_simple(polygon.outer)) << town;
      for (const auto& hole : polygon.holes) EXPECT_TRUE(geometry::is_simple(hole)) << town;
    }
    std::mt19937 random(20261121);
    std::uniform_int_distribution<std::size_t> any(0, road_map.lanes().size() - 1);
    std::uniform_real_distribution<double> offset_m(-8.0, 8.0);
    int inside = 0, outside = 0;
    for (int i = 0; i < 400; ++i) {
      const auto& ring = road_map.lanes()[any(random)].polygon;
      if (ring.empty()) continue;
      const Vector2d point = ring[0] + Vector2d(offset_m(random), offset_m(random));
      bool on_lane = false;
      double to_border_m = 1e300;
      for (const Lane& lane : road_map.lanes()) {
        if (!is_drivable(lane.type) || lane.polygon.empty()) continue;
        on_lane = on_lane || geometry::contains(lane.polygon, point);
        to_border_m = std::min(to_border_m, std::abs(lane.left.in_map.project(point).d_m));
        to_border_m = std::min(to_border_m, std::abs(lane.right.in_map.project(point).d_m));
      }
      if (to_border_m < 5e-3) continue;  // sampling and welding decide there
      EXPECT_EQ(any_contains(surface, point), on_lane) << town << ' ' << point.transpose();
      (on_lane ? inside : outside) += 1;
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
  }
}

}  // namespace
}  // namespace roadbed::map
