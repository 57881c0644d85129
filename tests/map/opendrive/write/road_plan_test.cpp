// Which way the lanes of a written road go, and what its roads are called.
#include "roadbed/map/opendrive/write/road_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/map/opendrive/write/written_map.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

// The way of each driving lane: where it begins and ends.
std::vector<std::array<Eigen::Vector2d, 2>> ways_of(const RoadMap& road_map) {
  std::vector<std::array<Eigen::Vector2d, 2>> ways;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    ways.push_back({road_map.to_source(lane.pose_at(0.0).position()),
                    road_map.to_source(lane.pose_at(lane.length_m()).position())});
  }
  std::ranges::sort(ways, {}, [](const auto& way) { return std::pair(way[0].x(), way[0].y()); });
  return ways;
}

void expect_same_ways(const RoadMap& before, int minor) {
  const opendrive::OpenDriveFile file = file_of(before, minor);
  const auto wanted = ways_of(before), found = ways_of(parse_map(file.bytes, "written.xodr"));
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const std::size_t end : {0U, 1U}) EXPECT_LE((found[i][end] - wanted[i][end]).norm(), 0.01);
  }
  for (const auto& [what, count] : file.lost) EXPECT_NE(what, "directions of lanes");
}

TEST(RoadPlan, LanesKeepTheirDirectionInEveryVersion) {
  tests::MadeRoad left_hand;
  left_hand.attributes = R"(rule="LHT")";
  tests::MadeRoad reversed;
  reversed.lanes =
      tests::made_section(0, tests::made_lane(1) + tests::made_lane(2), tests::made_lane(-1));
  reversed.lanes.replace(reversed.lanes.find("id=\"1\""), 6, R"(id="1" direction="reversed")");
  for (const tests::MadeRoad& road : {left_hand, reversed}) {
    for (const int minor : {4, 5, 6, 7, 8}) {
      SCOPED_TRACE(minor);
      expect_same_ways(tests::made_map(tests::made_road(road)), minor);
    }
  }
}

TEST(RoadPlan, RoadsThatHaveAnotherIdAreCounted) {
  tests::MadeRoad road;
  EXPECT_EQ(file_of(tests::made_map(tests::made_road(road))).lost,
            (std::vector<std::pair<std::string, std::size_t>>{
                {"ids of roads, which are no whole numbers", 1}}));
  road.id = "7";
  EXPECT_TRUE(file_of(tests::made_map(tests::made_road(road))).lost.empty());
}

}  // namespace
}  // namespace roadbed::map
