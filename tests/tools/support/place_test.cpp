#include "roadbed/tools/support/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/map/input_error.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

class PlaceTest : public testing::Test {
 protected:
  Place find(const std::string& text) { return find_place(road_map_, text, {"--from", ""}); }

  std::string name_at(const std::string& text) {
    return road_map_.lane(find(text).on_lane.lane).name;
  }

  std::string message_of(const std::string& text) {
    try {
      find_place(road_map_, text, {"a.json", "/goal"});
    } catch (const map::InputError& error) {
      return error.what();
    }
    return "found";
  }

  // 1/0/-1 eastwards south of the x axis, 1/0/1 westwards north of it.
  const map::RoadMap road_map_ = tests::straight_two_lane_road().build();
};

TEST_F(PlaceTest, LaneWithAndWithoutStation) {
  EXPECT_EQ(find("lane:1/0/-1").on_lane.s_m, 0.0);
  const Place there = find("lane:1/0/1@30");
  EXPECT_EQ(there.on_lane.s_m, 30.0);
  const Eigen::Vector2d in_source = road_map_.to_source(there.map_from_vehicle.position());
  EXPECT_NEAR(in_source.x(), 70.0, 1e-9);  // driven westwards
  EXPECT_NEAR(in_source.y(), 1.75, 1e-9);
}

TEST_F(PlaceTest, PointTakesTheNearestLaneAndItsHeading) {
  const Place there = find("20,-1");
  EXPECT_EQ(name_at("20,-1"), "1/0/-1");
  EXPECT_NEAR(there.on_lane.s_m, 20.0, 1e-9);
  EXPECT_NEAR(there.on_lane.d_m, 0.75, 1e-9);
  EXPECT_NEAR(there.map_from_vehicle.heading_rad, 0.0, 1e-9);
  EXPECT_EQ(name_at("20,-5.5"), "1/0/-1");  // 2 m off the road
}

TEST_F(PlaceTest, HeadingInDegreesChoosesTheLane) {
  EXPECT_EQ(name_at("20,0.5,10"), "1/0/-1");
  EXPECT_EQ(name_at("20,-0.5,190"), "1/0/1");
  EXPECT_NEAR(find("20,0.5,10").map_from_vehicle.heading_rad, std::numbers::pi / 18, 1e-12);
}

TEST_F(PlaceTest, WhatCannotBeFoundIsRefusedWithTheReason) {
  EXPECT_THAT(message_of("20,-9"), HasSubstr("a.json:/goal: place \"20,-9\": 5.5 m off"));
  EXPECT_THAT(message_of("20,-900"), HasSubstr("no drivable lane within"));
  EXPECT_THAT(message_of("20,-3.4,90"), HasSubstr("heading is against"));
  EXPECT_THAT(message_of("lane:9/0/-1"), HasSubstr("no lane has this name"));
  EXPECT_THAT(message_of("lane:1/0/-1@100.1"), HasSubstr("0 to 100.000 m"));
  EXPECT_THAT(message_of("lane:1/0/-1@-1"), HasSubstr("0 to 100.000 m"));
  for (const char* text : {"", "1", "1,", "1,2,3,4", "1;2", "nan,1", "1,inf", "lane:1/0/-1@x"}) {
    EXPECT_THAT(message_of(text), HasSubstr("X,Y or")) << text;
  }
}

}  // namespace
}  // namespace roadbed::tools
