#include "roadbed/tools/cli/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

// 1/0/-1 runs east below y = 0, 1/0/1 west above; the source's origin is far away.
map::RoadMap two_lane_road() {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.parts.origin_in_source = {500000.0, 4000000.0};
  return made.build();
}

std::string fault_of(const map::RoadMap& road_map, const std::string& text) {
  return tests::refusal_of([&] { find_place(road_map, text); });
}

TEST(FindPlace, TakesTheLaneThatAPointOfTheSourceIsOn) {
  const map::RoadMap road_map = two_lane_road();
  const Place place = find_place(road_map, "500020,3999998.5");
  EXPECT_EQ(road_map.lane(place.on_lane.lane).name, "1/0/-1");
  EXPECT_NEAR(place.on_lane.s_m, 20.0, 1e-6);
  EXPECT_NEAR(place.on_lane.d_m, 0.25, 1e-6);
  EXPECT_NEAR(place.map_from_vehicle.y_m, -1.5, 1e-6);
  EXPECT_NEAR(place.map_from_vehicle.heading_rad, 0.0, 1e-9);
  EXPECT_FALSE(place.has_heading);
}

TEST(FindPlace, HeadingDecidesBetweenLanesWithinReach) {
  const map::RoadMap road_map = two_lane_road();
  const auto name_at = [&](const std::string& text) {
    return road_map.lane(find_place(road_map, text).on_lane.lane).name;
  };
  EXPECT_EQ(name_at("500020,4000000.1,0"), "1/0/-1");
  EXPECT_EQ(name_at("500020,3999999.9,3.14159"), "1/0/1");
  EXPECT_EQ(name_at("500020,3999999.9,180deg"), "1/0/1");
  EXPECT_EQ(name_at("500020,3999998,180deg"), "1/0/-1");  // no other lane is near
  const Place place = find_place(road_map, "500020,3999998,-10deg");
  EXPECT_TRUE(place.has_heading);
  EXPECT_NEAR(place.map_from_vehicle.heading_rad, -std::numbers::pi / 18.0, 1e-12);
}

TEST(FindPlace, OfNumbersIsThatOfTheirText) {
  const map::RoadMap road_map = two_lane_road();
  const PointPlace point{{500020.0, 3999999.9}, std::numbers::pi + 40.0 * std::numbers::pi};
  const Place of_text = find_place(road_map, "500020,3999999.9,180deg");
  const Place of_numbers = find_place(road_map, point);
  EXPECT_EQ(of_numbers.on_lane.lane, of_text.on_lane.lane);
  EXPECT_EQ(of_numbers.on_lane.s_m, of_text.on_lane.s_m);
  EXPECT_EQ(of_numbers.sense, of_text.sense);
  EXPECT_TRUE(of_numbers.has_heading);
  EXPECT_FALSE(find_place(road_map, PointPlace{{500020.0, 3999998.0}, {}}).has_heading);
}

TEST(FindPlace, RefusesNumbersAsItRefusesText) {
  const map::RoadMap road_map = two_lane_road();
  const auto fault = [&](const PointPlace& point) -> std::string {
    return tests::refusal_of([&] { find_place(road_map, point); });
  };
  EXPECT_EQ(fault({{500020.0, 4000050.0}, {}}), fault_of(road_map, "500020,4000050"));
  EXPECT_THAT(fault({{500020.0, NAN}, {}}), HasSubstr("not a number"));
  EXPECT_THAT(fault({{500020.0, 4000000.0}, INFINITY}), HasSubstr("not a number"));
}

TEST(FindPlace, NamesALaneAndAStation) {
  const map::RoadMap road_map = two_lane_road();
  const Place place = find_place(road_map, "lane:1/0/1@30.5");
  EXPECT_EQ(road_map.lane(place.on_lane.lane).name, "1/0/1");
  EXPECT_NEAR(place.on_lane.s_m, 30.5, 1e-12);
  EXPECT_NEAR(place.map_from_vehicle.x_m, 69.5, 1e-9);
  EXPECT_EQ(find_place(road_map, "lane:1/0/1").on_lane.s_m, 0.0);
}

TEST(FindPlace, SaysHowFarAPointIsOffTheRoadAndWhereTheNearestLaneIs) {
  const map::RoadMap road_map = two_lane_road();
  const std::string fault = fault_of(road_map, "500040,3999990");
  EXPECT_THAT(fault, HasSubstr("500040,3999990"));
  EXPECT_THAT(fault, HasSubstr("1/0/-1, 6.50 m away"));
  EXPECT_THAT(fault, HasSubstr("500040.000,3999998.250"));
  EXPECT_THAT(fault_of(road_map, "0,0"), HasSubstr("off the road"));
}

TEST(FindPlace, RefusesUnknownLanesAndStationsBeyondThem) {
  const map::RoadMap road_map = two_lane_road();
  EXPECT_THAT(fault_of(road_map, "lane:9/0/1"), HasSubstr("no lane 9/0/1"));
  EXPECT_THAT(fault_of(road_map, "lane:1/0/1@100.5"), HasSubstr("100.000 m"));
  EXPECT_THAT(fault_of(road_map, "lane:1/0/1@-1"), HasSubstr("station -1"));
}

TEST(FindPlace, TellsBadWritingWithoutAMap) {
  for (const char* good : {"1,2", "-1.5e3,2", "1,2,3.1", "1,2,90deg", "lonlat:8.43,49.01",
                           "lonlat:-180,-90,90deg", "lane:1/0/-1", "lane:7@2.5"}) {
    EXPECT_EQ(place_syntax_fault(good), "") << good;
  }
  for (const char* bad : {"",
                          "1",
                          "1,",
                          "a,b",
                          "1,2,90",
                          "1,2,x",
                          "1,2,3,4",
                          "nan,1",
                          "1,inf",
                          "lane:",
                          "lane:@3",
                          "lane:1/0/1@",
                          "lane:1/0/1@x",
                          "1, 2",
                          "lonlat:",
                          "lonlat:8",
                          "lonlat:8,91",
                          "lonlat:181,0",
                          "lonlat:8,nan",
                          "lonlat:8,49,90",
                          "lonlat:lane:1"}) {
    EXPECT_NE(place_syntax_fault(bad), "") << bad;
  }
  for (const char* good : {"1,-2.5", "lonlat:8.43,49.01"}) {
    EXPECT_EQ(point_syntax_fault(good), "") << good;
  }
  for (const char* bad : {"1,2,3", "lonlat:8,49,1", "lonlat:8", "lonlat:49,98", "lane:1", ""}) {
    EXPECT_NE(point_syntax_fault(bad), "") << bad;
  }
}

}  // namespace
}  // namespace roadbed::tools
