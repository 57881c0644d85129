#include "roadbed/map/commonroad/write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <set>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

RoadMap there_and_back(const RoadMap& road_map) {
  return parse_map(commonroad::write_common_road(road_map), "written.xml");
}

double farthest_m(const RoadMap& a, const LaneLine& line, const RoadMap& b, const LaneLine& other) {
  if (line.in_map.points().size() != other.in_map.points().size()) return 1e300;
  double farthest = 0.0;
  for (std::size_t i = 0; i < line.z_m.size(); ++i) {
    const Eigen::Vector2d away =
        a.to_source(line.in_map.points()[i]) - b.to_source(other.in_map.points()[i]);
    farthest = std::max({farthest, away.norm(), std::abs(line.z_m[i] - other.z_m[i])});
  }
  return farthest;
}

void expect_same_network(const RoadMap& original, const RoadMap& back) {
  ASSERT_EQ(back.lanes().size(), original.lanes().size());
  for (const Lane& lane : original.lanes()) {
    const Lane& other = back.lane(lane.id);
    EXPECT_LT(farthest_m(original, lane.left, back, other.left), 1e-6) << lane.name;
    EXPECT_LT(farthest_m(original, lane.right, back, other.right), 1e-6) << lane.name;
    EXPECT_EQ(is_drivable(other.type), is_drivable(lane.type)) << lane.name;
    const auto limit = lane.least_speed_limit_mps(), read = other.least_speed_limit_mps();
    ASSERT_EQ(limit.has_value(), read.has_value()) << lane.name;
    EXPECT_NEAR(read.value_or(0.0), limit.value_or(0.0), 1e-9) << lane.name;
  }
}

TEST(WriteCommonRoad, TheTownComesBackAsItWas) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const RoadMap back = there_and_back(town);
  expect_same_network(town, back);
  for (const Lane& lane : town.lanes()) {
    const LaneLinks &links = town.graph().of(lane.id), &read = back.graph().of(lane.id);
    EXPECT_EQ(read.successors, links.successors) << lane.name;
    EXPECT_EQ(read.left.has_value(), links.left.has_value()) << lane.name;
    EXPECT_EQ(read.right.has_value(), links.right.has_value()) << lane.name;
  }
  EXPECT_EQ(back.crs(), town.crs());
}

TEST(WriteCommonRoad, TheJunctionComesBackWithItsRules) {
  const RoadMap junction = load_map(tests::data_folder() / "junction.xml");
  const RoadMap back = there_and_back(junction);
  expect_same_network(junction, back);
  ASSERT_THAT(back.signals(), SizeIs(2));
  EXPECT_EQ(back.signals()[1].attributes, junction.signals()[1].attributes);
  ASSERT_THAT(back.stop_lines(), SizeIs(1));
  EXPECT_EQ(back.stop_lines()[0].in_map, junction.stop_lines()[0].in_map);
  EXPECT_EQ(back.stop_lines()[0].signals, junction.stop_lines()[0].signals);
  ASSERT_THAT(back.regulations(), SizeIs(1));
  EXPECT_EQ(back.regulations()[0].members.size(), junction.regulations()[0].members.size());
  EXPECT_EQ(commonroad::write_common_road(back), commonroad::write_common_road(junction));
}

TEST(WriteCommonRoad, IdsAreWholeNumbersAndNoneIsGivenTwice) {
  const std::string text =
      commonroad::write_common_road(load_map(tests::data_folder() / "town.xodr"));
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str()));
  std::set<unsigned long long> ids;
  for (const auto& found : document.select_nodes("/commonRoad//*[@id]")) {
    const auto id = found.node().attribute("id").as_ullong();
    EXPECT_GT(id, 0U);
    EXPECT_TRUE(ids.insert(id).second) << id;
  }
  EXPECT_GT(ids.size(), 100U);
}

TEST(WriteCommonRoad, ChangesOfLaneSurviveWhereNoMarkingIsKnown) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId right = made.add_lane(road, "-2", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId left = made.add_lane(road, "-1", {{0, 6}, {50, 6}}, {{0, 3}, {50, 3}});
  for (const bool allowed : {true, false}) {
    made.put_beside(left, right, allowed);
    const RoadMap back = there_and_back(made.build());
    EXPECT_EQ(back.graph().of(right).left->change_allowed(), allowed);
    EXPECT_EQ(back.graph().of(left).right->change_allowed(), allowed);
  }
}

TEST(WriteCommonRoad, BordersThatDoNotPairGetPointsAtEachOthersStations) {
  tests::MadeMap made;
  const LaneId id = made.add_lane(made.add_road("1"), "-1", {{0, 3}, {10, 3}}, {{0, 0}, {10, 0}});
  Lane& lane = made.lane(id);
  lane.left = {geometry::Polyline({{0, 3}, {4, 3}, {10, 3}}), {0, 0, 0}, {0, 4, 10}};
  const RoadMap back = there_and_back(made.build());
  EXPECT_EQ(back.lane(id).right.in_map.points()[1], Eigen::Vector2d(4, 0));
  EXPECT_THAT(back.lane(id).left.in_map.points(), SizeIs(3));
}

TEST(WriteCommonRoad, LanesOfTypeNoneAreLeftOutWithWhatLeadsToThem) {
  tests::MadeMap made;
  const auto road = made.add_road("1");
  const LaneId driven = made.add_lane(road, "-1", {{0, 3}, {10, 3}}, {{0, 0}, {10, 0}});
  const LaneId none = made.add_lane(road, "-2", {{0, 0}, {10, 0}}, {{0, -3}, {10, -3}});
  made.lane(none).type = LaneType::none;
  made.put_beside(driven, none, true);
  const RoadMap back = there_and_back(made.build());
  ASSERT_THAT(back.lanes(), SizeIs(1));
  EXPECT_FALSE(back.graph().of(LaneId{0}).right.has_value());
}

TEST(WriteCommonRoad, WhatIsNotWrittenIsCounted) {
  tests::MadeMap made = tests::straight_two_lane_road();
  EXPECT_TRUE(commonroad::lost_in_common_road(made.build()).empty());
  Lane& lane = made.lane(LaneId{0});
  lane.speed_limits = {{0.0, 20.0}, {40.0, 10.0}};
  lane.right_marks = {{0.0, MarkType::solid, "white", 0.1}, {10.0, MarkType::broken, "white", 0.1}};
  made.lane(made.add_lane(RoadId{0}, "9", {{0, 30}, {10, 30}}, {{0, 28}, {10, 28}})).type =
      LaneType::none;
  Signal sign;
  sign.source_id = "5";
  sign.type = "101";
  made.parts.signals.push_back(sign);
  made.parts.objects.emplace_back();
  using Lost = std::pair<std::string, std::size_t>;
  EXPECT_EQ(
      commonroad::lost_in_common_road(made.build()),
      (std::vector<Lost>{{"lanes of type none", 1},
                         {"changes of the speed limit along a lane, which has the least", 1},
                         {"changes of the marking along a border, which has the longest", 1},
                         {"signs that speak to no lane, or say another limit than its own", 1},
                         {"objects", 1}}));
}

TEST(WriteCommonRoad, SaysWhereItsCoordinatesAreInTheirSystem) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.crs = "EPSG:25832";
  made.parts.offset_in_crs = {.x_m = 500'000.0, .y_m = 5'400'000.5, .heading_rad = 0.25};
  const RoadMap back = there_and_back(made.build());
  EXPECT_EQ(back.crs(), "EPSG:25832");
  EXPECT_EQ(back.offset_in_crs(), made.parts.offset_in_crs);
  EXPECT_TRUE(back.import_diagnostics().empty());
}

TEST(WriteCommonRoad, TheCountryIsThatOfTheSigns) {
  tests::MadeMap made = tests::straight_two_lane_road();
  Signal sign;
  sign.source_id = "5";
  sign.type = "274.1";
  sign.country = "DE";
  sign.lanes = {LaneId{0}};
  made.parts.signals = {sign};
  EXPECT_THAT(commonroad::write_common_road(made.build()), HasSubstr("\"DEU_Roadbed-1\""));
  made.parts.signals[0].country = "OpenDRIVE";
  EXPECT_THAT(commonroad::write_common_road(made.build()), HasSubstr("\"ZAM_Roadbed-1\""));
}

TEST(WriteCommonRoad, NumbersHaveNoExponent) {
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", {{1e-7, 3}, {10, 3}}, {{0, 0}, {10, 0}});
  EXPECT_THAT(commonroad::write_common_road(made.build()), Not(HasSubstr("e-")));
}

TEST(WriteCommonRoad, ALightWithoutACycleIsOff) {
  tests::MadeMap made = tests::straight_two_lane_road();
  Signal light;
  light.source_id = "a";
  light.dynamic = true;
  light.lanes = {LaneId{0}};
  made.parts.signals = {light};
  EXPECT_THAT(commonroad::write_common_road(made.build()), HasSubstr("<color>inactive</color>"));
}

}  // namespace
}  // namespace roadbed::map
