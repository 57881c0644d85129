// Who gives way where two lanes become one.
#include "roadbed/planning/task/lane_join.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using tests::lane_of;

/// The ramp's map, with more in its junction.
map::RoadMap ramp_map(const std::string& in_junction = "") {
  std::ifstream file(tests::data_folder() / "ramp.xodr");
  std::stringstream text;
  text << file.rdbuf();
  std::string document = text.str();
  const std::string end = "</junction>";
  document.insert(document.find(end), in_junction);
  const auto path =
      std::filesystem::path(testing::TempDir()) / fmt::format("lane_join_{}.xodr", ::getpid());
  std::ofstream(path) << document;
  return map::load_map(path);
}

std::optional<LaneJoin> join_of(const map::RoadMap& road_map, const std::string& lane) {
  return join_to_give_way_at(road_map, lane_of(road_map, lane).id);
}

TEST(LaneJoin, RampGivesWayToTheRoadOfMoreLanesFromWhereTheyOverlap) {
  const map::RoadMap road_map = ramp_map();
  const auto ramp = join_of(road_map, "1001/0/-1");
  ASSERT_TRUE(ramp);
  EXPECT_EQ(road_map.lane(ramp->other).name, "1000/0/-2");
  // The ramp's left edge crosses the road's right one, y = -7 m.
  const map::Lane& lane = lane_of(road_map, "1001/0/-1");
  const auto left_edge_y_m = [&](double s_m) { return map::Lane::point_at(lane.left, s_m).y(); };
  EXPECT_NEAR(left_edge_y_m(ramp->from_s_m), -7.0, 0.1);
  EXPECT_FALSE(join_of(road_map, "1000/0/-2"));
  EXPECT_FALSE(join_of(road_map, "1000/0/-1"));
  EXPECT_FALSE(join_of(road_map, "1/0/-2"));
}

TEST(LaneJoin, PriorityOfTheJunctionComesFirst) {
  const map::RoadMap road_map = ramp_map(R"(<priority high="1001" low="1000"/>)");
  EXPECT_FALSE(join_of(road_map, "1001/0/-1"));
  ASSERT_TRUE(join_of(road_map, "1000/0/-2"));
  EXPECT_FALSE(join_of(road_map, "1000/0/-1"));
}

}  // namespace
}  // namespace roadbed::planning
