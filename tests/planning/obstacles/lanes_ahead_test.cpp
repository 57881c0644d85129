#include "roadbed/planning/obstacles/lanes_ahead.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

TEST(LanesAhead, GoesStraightOnFromLaneToLane) {
  const map::RoadMap road_map = tests::three_roads_in_a_row().build();
  const map::LaneId first = *road_map.find_lane("1/0/-1");
  const geometry::Polyline way = straight_on(road_map, {.lane = first, .s_m = 10.0}, 100.0);
  EXPECT_NEAR(way.at(0.0).x(), 10.0, 1e-9);
  EXPECT_NEAR(way.at(75.0).x(), 85.0, 1e-9);
  EXPECT_NEAR(way.at(75.0).y(), 0.0, 1e-9);
  const geometry::Polyline all = straight_on(road_map, {.lane = first, .s_m = 10.0}, 1e6);
  EXPECT_NEAR(all.length_m(), 140.0, 1e-9);  // the lanes end
}

TEST(LanesAhead, NobodyTurnsRoundWhereLanesJoin) {
  const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  for (std::uint32_t i = 0; i < road_map.lanes().size(); ++i) {
    const map::LaneId lane{i};
    if (!map::is_drivable(road_map.lane(lane).type)) continue;
    const geometry::Polyline way = straight_on(road_map, {.lane = lane, .s_m = 0.0}, 300.0);
    for (std::size_t k = 2; k < way.points().size(); ++k) {
      const Eigen::Vector2d before = way.points()[k - 1] - way.points()[k - 2];
      const Eigen::Vector2d after = way.points()[k] - way.points()[k - 1];
      ASSERT_GT(before.dot(after), 0.0) << road_map.lane(lane).name << ", point " << k;
    }
  }
}

/// Every way of at least a length, by trying all successors.
std::set<std::vector<std::uint32_t>> all_ways(const map::RoadMap& road_map, map::LaneId lane,
                                              double left_m) {
  left_m -= road_map.lane(lane).centre.in_map.length_m();
  std::set<std::vector<std::uint32_t>> ways;
  if (left_m > 0.0) {
    for (const map::LaneId next : road_map.graph().of(lane).successors) {
      if (!map::is_drivable(road_map.lane(next).type)) continue;
      for (std::vector<std::uint32_t> way : all_ways(road_map, next, left_m)) {
        way.insert(way.begin(), lane.index);
        ways.insert(std::move(way));
      }
    }
  }
  if (ways.empty()) ways.insert({lane.index});
  return ways;
}

TEST(LanesAhead, AreAllThatLeadOnOrTheFirstOfThem) {
  const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  std::size_t forks = 0;
  for (std::uint32_t i = 0; i < road_map.lanes().size(); ++i) {
    const map::LaneId lane{i};
    if (!map::is_drivable(road_map.lane(lane).type)) continue;
    const auto expected = all_ways(road_map, lane, 250.0);
    std::set<std::vector<std::uint32_t>> found;
    for (const LanesAhead& way : ways_ahead(road_map, {.lane = lane, .s_m = 0.0}, 250.0, 1000)) {
      std::vector<std::uint32_t> lanes;
      for (const map::LaneId one : way.lanes) lanes.push_back(one.index);
      found.insert(std::move(lanes));
    }
    EXPECT_EQ(found, expected) << road_map.lane(lane).name;
    forks += expected.size() > 1 ? 1 : 0;
    const auto first = ways_ahead(road_map, {.lane = lane, .s_m = 0.0}, 250.0, 2);
    EXPECT_EQ(first.size(), std::min<std::size_t>(2, expected.size()));
    EXPECT_EQ(first.front().lanes,
              ways_ahead(road_map, {.lane = lane, .s_m = 0.0}, 250.0, 1).front().lanes);
  }
  EXPECT_GT(forks, 10u);
}

}  // namespace
}  // namespace roadbed::planning
