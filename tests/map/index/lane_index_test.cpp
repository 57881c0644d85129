#include "roadbed/map/index/lane_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "roadbed/map/index/road_map_index.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

// All lanes within the radius, by looking at every point of all of them.
std::vector<LaneMatch> by_brute_force(const RoadMap& road_map, const Eigen::Vector2d& point,
                                      double radius_m) {
  std::vector<LaneMatch> found;
  for (const Lane& lane : road_map.lanes()) {
    if (lane.polygon.size() < 3) continue;
    geometry::Ring closed = lane.polygon;
    closed.push_back(closed.front());
    const double to_edge_m = std::abs(geometry::Polyline(closed).project(point).d_m);
    const double distance_m = geometry::contains(lane.polygon, point) ? 0.0 : to_edge_m;
    if (distance_m > radius_m) continue;
    const auto beside = lane.centre.in_map.project(point);
    found.push_back({{lane.id, beside.s_m, beside.d_m}, distance_m, 0.0});
  }
  std::sort(found.begin(), found.end(), [](const LaneMatch& a, const LaneMatch& b) {
    return std::tuple(a.distance_m, std::abs(a.place.d_m), a.place.lane) <
           std::tuple(b.distance_m, std::abs(b.place.d_m), b.place.lane);
  });
  return found;
}

std::vector<Eigen::Vector2d> points_near_lanes(const RoadMap& road_map, int count, double reach_m) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> aside(-reach_m, reach_m), along(0.0, 1.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const Lane& lane = road_map.lanes()[random() % road_map.lanes().size()];
    points.push_back(lane.pose_at(along(random) * lane.length_m()) *
                     Eigen::Vector2d(0.0, aside(random)));
  }
  return points;
}

const LaneMatch& of_lane(const std::vector<LaneMatch>& matches, LaneId lane) {
  return *std::find_if(matches.begin(), matches.end(),
                       [&](const LaneMatch& match) { return match.place.lane == lane; });
}

void expect_same_lanes(std::vector<LaneMatch> found, const std::vector<LaneMatch>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].distance_m, expected[i].distance_m, 1e-9);
    const LaneMatch& same = of_lane(found, expected[i].place.lane);
    ASSERT_EQ(same.place.lane, expected[i].place.lane);
    EXPECT_NEAR(same.distance_m, expected[i].distance_m, 1e-9);
    EXPECT_NEAR(same.place.s_m, expected[i].place.s_m, 1e-6);
    EXPECT_NEAR(std::abs(same.place.d_m), std::abs(expected[i].place.d_m), 1e-9);
  }
}

void compare_with_brute_force(const RoadMap& road_map, int count) {
  for (const Eigen::Vector2d& point : points_near_lanes(road_map, count, 30.0)) {
    const auto expected = by_brute_force(road_map, point, 20.0);
    expect_same_lanes(road_map.index().lanes.near(point, {.radius_m = 20.0}), expected);
    for (const double radius_m : {0.0, 1.0, 20.0}) {
      const auto is_within = [&](const auto& lane) { return lane.distance_m <= radius_m; };
      EXPECT_EQ(road_map.index().lanes.is_any_near(point, {.radius_m = radius_m, .count = 1}),
                std::ranges::any_of(expected, is_within));
    }
    const auto nearest = road_map.index().lanes.near(point, {.radius_m = 20.0, .count = 1});
    ASSERT_EQ(nearest.size(), std::min<std::size_t>(1, expected.size()));
    if (nearest.empty()) continue;
    EXPECT_NEAR(nearest[0].distance_m, expected[0].distance_m, 1e-9) << point.transpose();
    EXPECT_NEAR(std::abs(nearest[0].place.d_m), std::abs(expected[0].place.d_m), 1e-6)
        << point.transpose();
  }
}

TEST(LaneIndex, FindsWhatBruteForceFinds) {
  compare_with_brute_force(tests::curved_two_lane_road(), 300);
}

TEST(LaneIndex, FindsWhatBruteForceFindsInRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  for (const char* name : {"Town01.xodr", "Town04.xodr"}) {
    compare_with_brute_force(load_map(real / "opendrive/BerkeleyLearnVerify+Scenic" / name), 200);
  }
}

// Rings that have little to do with their lanes' borders: stars of many corners.
RoadMap stars() {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> radius_m(2.0, 30.0), place_m(-60.0, 60.0);
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  for (int star = 0; star < 20; ++star) {
    const Eigen::Vector2d middle(place_m(random), place_m(random));
    const LaneId lane =
        made.add_lane(road, std::to_string(star + 1), {middle, middle + Eigen::Vector2d(5.0, 0.0)},
                      {middle - Eigen::Vector2d(0.0, 1.0), middle});
    const int corners = 3 + static_cast<int>(random() % 200);
    geometry::Ring ring;
    for (int i = 0; i < corners; ++i) {
      const double angle_rad = 2.0 * M_PI * i / corners;
      ring.push_back(middle +
                     radius_m(random) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
    }
    made.lane(lane).polygon = ring;
  }
  return made.build();
}

TEST(LaneIndex, TellsInsideFromOutsideWhateverTheRing) {
  const RoadMap road_map = stars();
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> place_m(-90.0, 90.0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d point(place_m(random), place_m(random));
    expect_same_lanes(road_map.index().lanes.near(point, {.radius_m = 10.0}),
                      by_brute_force(road_map, point, 10.0));
  }
}

TEST(LaneIndex, CallsAPointOnTheBorderInside) {
  const RoadMap road_map = tests::curved_two_lane_road();
  for (const Lane& lane : road_map.lanes()) {
    for (const Eigen::Vector2d& corner : lane.polygon) {
      const auto found = road_map.index().lanes.near(corner, {.radius_m = 0.0});
      EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const LaneMatch& match) {
        return match.place.lane == lane.id && match.distance_m == 0.0;
      }));
    }
  }
}

TEST(LaneIndex, FindsTheFewNearestOfAll) {
  const RoadMap road_map = stars();
  for (const Eigen::Vector2d& point : points_near_lanes(road_map, 300, 80.0)) {
    const auto all = road_map.index().lanes.near(point, {});
    EXPECT_EQ(all.size(), 20U);
    for (const std::size_t count : {1U, 2U, 5U, 19U}) {
      const auto few = road_map.index().lanes.near(point, {.count = count});
      ASSERT_EQ(few.size(), count);
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(few[i].place.lane, all[i].place.lane);
    }
  }
}

void expect_as_one_by_one(const RoadMap& road_map, const std::vector<Eigen::Vector2d>& points,
                          const LaneQuery& query) {
  const LaneMatches many = road_map.index().lanes.near(points, query);
  ASSERT_EQ(many.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto one = road_map.index().lanes.near(points[i], query);
    ASSERT_EQ(many.of(i).size(), one.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_EQ(many.of(i)[k].place.lane, one[k].place.lane);
      EXPECT_EQ(many.of(i)[k].place.s_m, one[k].place.s_m);
    }
  }
}

TEST(LaneIndex, AnswersManyPointsAsOneByOne) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  auto points = points_near_lanes(town, 2000, 60.0);
  points[7] = {std::nan(""), 0.0};
  points[8] = {INFINITY, 0.0};
  for (const std::size_t count : {1U, 2U, 5U}) {
    expect_as_one_by_one(town, points, {.radius_m = 25.0, .count = count});
    expect_as_one_by_one(town, points, {.radius_m = 1000.0, .count = count});
  }
  EXPECT_TRUE(town.index().lanes.near(points, {.radius_m = 25.0, .count = 1}).of(7).empty());
  EXPECT_TRUE(town.index().lanes.near(points, {.radius_m = 25.0, .count = 1}).of(8).empty());
}

TEST(LaneIndex, FindsEveryLaneWithACornerInABox) {
  const RoadMap road_map = stars();
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> place_m(-90.0, 90.0), size_m(0.0, 40.0);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d low(place_m(random), place_m(random));
    const Eigen::Vector2d high = low + Eigen::Vector2d(size_m(random), size_m(random));
    const auto found = road_map.index().lanes.in_box(low, high, LaneTypes::all());
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (const Lane& lane : road_map.lanes()) {
      const bool corner_inside =
          std::any_of(lane.polygon.begin(), lane.polygon.end(), [&](const Eigen::Vector2d& p) {
            return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
          });
      const bool listed = std::binary_search(found.begin(), found.end(), lane.id);
      EXPECT_TRUE(listed || !corner_inside) << lane.name;
    }
  }
}

TEST(LaneIndex, HasTheBoxOfAllLanes) {
  const RoadMap road_map = stars();
  geometry::Box expected;
  for (const Lane& lane : road_map.lanes()) {
    for (const Eigen::Vector2d& point : lane.polygon) expected.extend(point);
  }
  const geometry::Box box = road_map.index().lanes.box();
  EXPECT_TRUE(box.contains(expected));
  EXPECT_LT((box.sizes() - expected.sizes()).maxCoeff(), 1e-4);  // float, rounded outwards
  EXPECT_TRUE(tests::MadeMap().build().index().lanes.box().isEmpty());
}

TEST(LaneIndex, LooksOnlyAtTheTypesAskedFor) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.lanes[1].type = LaneType::sidewalk;
  const RoadMap road_map = made.build();
  const Eigen::Vector2d on_sidewalk = road_map.lanes()[1].pose_at(20.0).position();
  const auto found =
      road_map.index().lanes.near(on_sidewalk, {.radius_m = 9.0, .types = LaneTypes::drivable()});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].place.lane.index, 0U);
  EXPECT_NEAR(found[0].distance_m, 1.75, 1e-9);
}

}  // namespace
}  // namespace roadbed::map
