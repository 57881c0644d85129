#include "roadbed/map/model/road_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

// The nearest lane by looking at all of them.
LaneId nearest_by_brute_force(const RoadMap& road_map, const Eigen::Vector2d& point,
                              double& distance_m) {
  LaneId nearest{};
  std::pair<double, double> best{std::numeric_limits<double>::infinity(), 0.0};
  for (const Lane& lane : road_map.lanes()) {
    if (lane.polygon.size() < 3) continue;
    geometry::Ring closed = lane.polygon;
    closed.push_back(closed.front());
    const double to_edge_m = std::abs(geometry::Polyline(closed).project(point).d_m);
    const double outside_m = geometry::contains(lane.polygon, point) ? 0.0 : to_edge_m;
    const std::pair key{outside_m, std::abs(lane.centre.in_map.project(point).d_m)};
    if (key < best) {
      best = key;
      nearest = lane.id;
    }
  }
  distance_m = best.first;
  return nearest;
}

void compare_with_brute_force(const RoadMap& road_map, int points) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> aside(-20.0, 20.0), along(0.0, 1.0);
  for (int i = 0; i < points; ++i) {
    const Lane& lane = road_map.lanes()[random() % road_map.lanes().size()];
    const Eigen::Vector2d point = lane.pose_at(along(random) * lane.length_m()) *
                                  Eigen::Vector2d(aside(random), aside(random));
    double distance_m = 0.0;
    const LaneId expected = nearest_by_brute_force(road_map, point, distance_m);
    const auto found = road_map.locate(point, 50.0, false);
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found.front().distance_m, distance_m, 1e-9) << "point " << point.transpose();
    if (distance_m == 0.0) {
      EXPECT_EQ(found.front().place.lane, expected) << point.transpose();
    }
  }
}

TEST(RoadMap, LocateFindsWhatBruteForceFinds) {
  compare_with_brute_force(tests::curved_two_lane_road(), 500);
}

TEST(RoadMap, LocateFindsWhatBruteForceFindsInARealTown) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  compare_with_brute_force(load_map(real / "opendrive/BerkeleyLearnVerify+Scenic/Town01.xodr"), 60);
}

TEST(RoadMap, LocateGivesBackThePlaceOnTheLane) {
  const RoadMap road_map = tests::curved_two_lane_road();
  for (const Lane& lane : road_map.lanes()) {
    const double s_m = 0.37 * lane.length_m();
    const auto found = road_map.locate(lane.pose_at(s_m) * Eigen::Vector2d(0.0, 0.4), 1.0, false);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found.front().place.lane, lane.id);
    EXPECT_NEAR(found.front().place.s_m, s_m, 0.02);  // the chord's kink at a vertex, times d
    EXPECT_NEAR(found.front().place.d_m, 0.4, 1e-4);
  }
}

TEST(RoadMap, ShouldersAreSurfaceButNotDrivable) {
  const RoadMap road_map = tests::curved_two_lane_road();
  const Lane& shoulder = road_map.lane(road_map.find_lane("7/0/-2").value());
  const Eigen::Vector2d on_it = shoulder.pose_at(10.0).position();
  EXPECT_TRUE(road_map.on_surface(on_it, 0.0));
  EXPECT_TRUE(road_map.locate(on_it, 0.1, true).empty());
  EXPECT_FALSE(road_map.on_surface(shoulder.pose_at(10.0) * Eigen::Vector2d(0.0, -3.0), 0.0));
  EXPECT_TRUE(road_map.on_surface(shoulder.pose_at(10.0) * Eigen::Vector2d(0.0, -3.0), 2.5));
}

TEST(RoadMap, RefusesPartsWhoseIdsNameNothing) {
  RoadMapParts parts = tests::curved_two_lane_road().parts();
  parts.lanes[0].road = RoadId{99};
  EXPECT_THROW(RoadMap{parts}, std::invalid_argument);
  parts = tests::curved_two_lane_road().parts();
  parts.links[0].successors.push_back(LaneId{99});
  EXPECT_THROW(RoadMap{parts}, std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
