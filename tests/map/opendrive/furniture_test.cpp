// Signals, controllers, stop lines and objects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using tests::lane_of;
using tests::made_lane;
using tests::made_map;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

RoadMap with(const std::string& rest, const std::string& body = {}) {
  MadeRoad road;
  road.rest = rest;
  return made_map(made_road(road) + body);
}

std::vector<std::string> lane_names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::vector<std::string> names;
  for (const LaneId id : lanes) names.push_back(road_map.lane(id).name);
  return names;
}

TEST(OpenDriveSignals, StandAtTheirPlaceAndFaceTheirTraffic) {
  const RoadMap road_map = with(R"(<signals>
    <signal id="1" s="20" t="-5" zOffset="2.5" orientation="+" dynamic="yes" type="1000001" text="Hi"/>
    <signal id="2" s="30" t="5" orientation="-" hOffset="0.2" country="DE" type="274" value="50"/>
    <signal id="3" s="40" t="0" orientation="none" type="1"/></signals>)");
  ASSERT_EQ(road_map.signals().size(), 3u);
  const Signal& light = road_map.signals()[0];
  EXPECT_NEAR((light.in_map - Eigen::Vector2d(20, -5)).norm(), 0.0, 1e-12);
  EXPECT_EQ(light.z_m, 2.5);
  EXPECT_NEAR(std::abs(light.heading_rad.value()), std::numbers::pi, 1e-12);  // towards oncoming +x
  EXPECT_TRUE(light.dynamic);
  EXPECT_EQ(light.text, "Hi");
  EXPECT_THAT(lane_names(road_map, light.lanes), ElementsAre("A/0/-1"));
  EXPECT_THAT(light.lane_s_m, ElementsAre(testing::DoubleNear(20.0, 1e-9)));
  const Signal& sign = road_map.signals()[1];
  EXPECT_NEAR(sign.heading_rad.value(), 0.2, 1e-12);
  EXPECT_THAT(lane_names(road_map, sign.lanes), ElementsAre("A/0/1"));
  EXPECT_THAT(sign.lane_s_m, ElementsAre(testing::DoubleNear(70.0, 1e-9)));
  EXPECT_EQ(sign.value, 50.0);
  EXPECT_FALSE(road_map.signals()[2].heading_rad);
  EXPECT_EQ(road_map.signals()[2].lanes.size(), 2u);
}

TEST(OpenDriveSignals, LeanWithTheRoad) {
  MadeRoad road;
  road.elevation = R"(<elevation s="0" a="10" b="0" c="0" d="0"/>)";
  road.lateral = R"(<superelevation s="0" a="0.1" b="0" c="0" d="0"/>)";
  road.rest = R"(<signals><signal id="1" s="20" t="-5" zOffset="4"/></signals>)";
  const RoadMap road_map = made_map(made_road(road));
  const Signal& signal = road_map.signals()[0];
  EXPECT_NEAR(signal.in_map.y(), -5 * std::cos(0.1) - 4 * std::sin(0.1), 1e-12);
  EXPECT_NEAR(signal.z_m, 10 - 5 * std::sin(0.1) + 4 * std::cos(0.1), 1e-12);
}

TEST(OpenDriveSignals, SpeakToTheLanesOfRoadsThatReferToThem) {
  MadeRoad other;
  other.id = "B";
  other.x_m = 200.0;
  other.rest = R"(<signals><signalReference id="1" s="10" t="4" orientation="+">
    <validity fromLane="-1" toLane="-1"/></signalReference>
    <signalReference id="99" s="0" t="0" orientation="+"/></signals>)";
  const RoadMap road_map = with(
      R"(<signals><signal id="1" s="95" t="-5" orientation="+"/></signals>)", made_road(other));
  const Signal& signal = road_map.signals()[0];
  EXPECT_THAT(lane_names(road_map, signal.lanes), ElementsAre("A/0/-1", "B/0/-1"));
  EXPECT_NEAR(signal.lane_s_m[1], 10.0, 1e-9);
  EXPECT_THAT(signal.attributes, Contains(Pair("signalReference", "road B, s 10, t 4")));
  EXPECT_THAT(tests::remarks_of(road_map, "import.signal"),
              ElementsAre(HasSubstr("road B: refers to signal 99")));
}

// Some tools write the orientation the other way round; the lanes that are named count.
TEST(OpenDriveSignals, ValidityThatContradictsTheOrientationWins) {
  const RoadMap road_map = with(R"(<signals><signal id="1" s="5" t="0" orientation="-">
    <validity fromLane="-1" toLane="-1"/></signal></signals>)");
  EXPECT_THAT(lane_names(road_map, road_map.signals()[0].lanes), ElementsAre("A/0/-1"));
}

TEST(OpenDriveSignals, KeepDependenciesReferencesAndPositions) {
  const RoadMap road_map = with(R"(<signals>
    <signal id="1" s="5" t="0"><dependency id="2" type="limitline"/>
      <reference elementType="object" elementId="7" type="t"/></signal>
    <signal id="2" s="6" t="0" orientation="+"><positionInertial x="50" y="60" z="7" hdg="0.5"/></signal>
    <signal id="3" s="6" t="0"><positionRoad roadId="A" s="90" t="2" zOffset="1"/></signal></signals>)");
  const Signal& first = road_map.signals()[0];
  EXPECT_THAT(first.attributes, Contains(Pair("dependency", "id 2, type limitline")));
  EXPECT_THAT(first.attributes,
              Contains(Pair("reference", "elementType object, elementId 7, type t")));
  const Signal& inertial = road_map.signals()[1];
  EXPECT_EQ(inertial.in_map, Eigen::Vector2d(50, 60));
  EXPECT_NEAR(inertial.heading_rad.value(), 0.5 - std::numbers::pi, 1e-12);
  EXPECT_NEAR((road_map.signals()[2].in_map - Eigen::Vector2d(90, 2)).norm(), 0.0, 1e-12);
  EXPECT_EQ(road_map.signals()[2].z_m, 1.0);
}

TEST(OpenDriveSignals, OneThatCannotBeReadIsLeftOutAndSaid) {
  const RoadMap road_map = with(R"(<signals><signal id="1" s="nan" t="0"/>
    <signal id="2" s="1e300" t="0"/><signal id="3" s="5" t="0"/></signals>)");
  ASSERT_EQ(road_map.signals().size(), 1u);
  EXPECT_EQ(road_map.signals()[0].source_id, "3");
  EXPECT_THAT(tests::remarks_of(road_map, "import.signal"),
              ElementsAre(HasSubstr("s=\"nan\""), HasSubstr("signal 2: stands where no map")));
}

TEST(OpenDriveControllers, NameTheirSignalsAndJunctions) {
  const RoadMap road_map = with("", R"(<controller id="c" name="main" sequence="1">
      <control signalId="1" type="x"/><control signalId="2"/></controller>
    <junction id="J" name=""><controller id="c" type="t" sequence="3"/></junction>)");
  ASSERT_EQ(road_map.controllers().size(), 1u);
  const Controller& controller = road_map.controllers()[0];
  EXPECT_EQ(controller.name, "main");
  EXPECT_THAT(controller.signals, ElementsAre("1", "2"));
  EXPECT_THAT(controller.attributes,
              ElementsAre(Pair("sequence", "1"), Pair("junction", "J, sequence 3")));
}

TEST(OpenDriveStopLines, AreFoundInObjectsAndSignals) {
  const RoadMap road_map = with(R"(<objects>
    <object id="o1" name="StopLine" type="-1" s="90" t="-1.75" hdg="1.5707963267948966" length="3.5" width="0">
      <outline><cornerLocal u="-1.75" v="0" z="0"/><cornerLocal u="1.75" v="0" z="0"/></outline></object>
    <object id="o2" type="roadMark" subtype="stop_line" s="10" t="0" length="0.3" width="7">
      <validity fromLane="1" toLane="1"/></object>
    <object id="o3" type="roadMark" name="Stopping" s="10" t="0" length="1" width="1"/></objects>
    <signals><signal id="s1" s="95" t="-1.75" orientation="+" type="294" width="3.4"/>
      <signal id="light" s="99" t="-5" orientation="+" dynamic="yes" type="1000001"/></signals>)");
  ASSERT_EQ(road_map.stop_lines().size(), 3u);
  const StopLine& across = road_map.stop_lines()[0];
  EXPECT_THAT(lane_names(road_map, across.lanes), ElementsAre("A/0/-1"));
  EXPECT_THAT(across.signals, ElementsAre("light"));
  EXPECT_NEAR((across.in_map.back() - across.in_map.front()).norm(), 3.5, 1e-9);
  EXPECT_NEAR(across.in_map.front().x(), 90.0, 1e-9);
  const StopLine& named = road_map.stop_lines()[1];
  EXPECT_THAT(lane_names(road_map, named.lanes), ElementsAre("A/0/1"));
  EXPECT_NEAR(std::abs(named.in_map.back().y() - named.in_map.front().y()), 7.0, 1e-6);
  const StopLine& painted = road_map.stop_lines()[2];
  EXPECT_EQ(painted.source_id, "s1");
  EXPECT_NEAR((painted.in_map.back() - painted.in_map.front()).norm(), 3.4, 1e-9);
  EXPECT_THAT(lane_names(road_map, painted.lanes), ElementsAre("A/0/-1"));
}

TEST(OpenDriveObjects, HaveTheOutlineThatTheFileGivesThem) {
  const RoadMap road_map = with(R"(<objects>
    <object id="1" type="crosswalk" s="50" t="0" hdg="1.5707963267948966"><outlines>
      <outline id="0"><cornerLocal u="-3" v="-2" z="0"/><cornerLocal u="3" v="-2" z="0"/>
        <cornerLocal u="3" v="2" z="0"/><cornerLocal u="-3" v="2" z="0"/></outline>
      <outline id="1"><cornerRoad s="10" t="0" dz="1" height="2"/><cornerRoad s="14" t="0"/>
        <cornerRoad s="14" t="-5"/></outline></outlines></object>
    <object id="2" type="building" s="20" t="20" length="4" width="3" height="9" zOffset="1"/>
    <object id="3" type="pole" s="20" t="-8" radius="0.5"/>
    <object id="4" type="tree" s="20" t="-9"/></objects>)");
  const auto& objects = road_map.objects();
  ASSERT_EQ(objects.size(), 5u);
  const auto area = [&](std::size_t i) {
    return geometry::signed_area_m2(objects[i].outline_in_map);
  };
  EXPECT_EQ(objects[0].type, "crosswalk");
  EXPECT_NEAR(area(0), 24.0, 1e-9);
  EXPECT_TRUE(geometry::contains(objects[0].outline_in_map, {51.9, 2.9}));
  EXPECT_FALSE(geometry::contains(objects[0].outline_in_map, {52.1, 2.9}));
  EXPECT_EQ(objects[1].source_id, "1");
  EXPECT_NEAR(area(1), 10.0, 1e-9);  // the ring was clockwise
  EXPECT_NEAR(area(2), 12.0, 1e-9);
  EXPECT_EQ(objects[2].height_m, 9.0);
  EXPECT_EQ(objects[2].z_m, 1.0);
  EXPECT_NEAR(area(3), 8.0 * 0.25 * std::sin(std::numbers::pi / 8.0), 1e-9);  // 16 corners
  EXPECT_TRUE(objects[4].outline_in_map.empty());
  EXPECT_EQ(objects[4].in_map, Eigen::Vector2d(20, -9));
}

TEST(OpenDriveObjects, RepeatAsCopiesOrAsOneBody) {
  const RoadMap road_map = with(R"(<objects>
    <object id="posts" type="pole" s="0" t="0" radius="0.1">
      <repeat s="10" length="20" distance="5" tStart="4" tEnd="6" zOffsetStart="0" zOffsetEnd="1"/></object>
    <object id="rail" type="barrier" s="0" t="0">
      <repeat s="40" length="30" distance="0" tStart="-5" tEnd="-5" widthStart="0.5" widthEnd="0.5" heightStart="0.8"/>
    </object></objects>)");
  const auto& objects = road_map.objects();
  ASSERT_EQ(objects.size(), 6u);
  EXPECT_NEAR((objects[2].in_map - Eigen::Vector2d(20, 5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(objects[2].z_m, 0.5, 1e-12);
  EXPECT_NEAR(objects[4].road_s_m, 30.0, 1e-12);
  EXPECT_NEAR(geometry::signed_area_m2(objects[5].outline_in_map), 15.0, 1e-9);
  EXPECT_EQ(objects[5].height_m, 0.8);
}

TEST(OpenDriveObjects, ParkingSpacesSayWhoMayParkAndReferencesAreKept) {
  MadeRoad other;
  other.id = "B";
  other.x_m = 200.0;
  other.rest = R"(<objects><objectReference id="p" s="1" t="2" orientation="none"/></objects>)";
  const RoadMap road_map = with(R"(<objects><object id="p" type="parkingSpace" s="5" t="-6"
    length="5" width="2.5"><parkingSpace access="handicapped" restrictions="2 h"/></object></objects>)",
                                made_road(other));
  ASSERT_EQ(road_map.objects().size(), 1u);
  const Attributes& attributes = road_map.objects()[0].attributes;
  EXPECT_THAT(attributes, Contains(Pair("parkingSpace", "access handicapped, restrictions 2 h")));
  EXPECT_THAT(attributes, Contains(Pair("objectReference", "road B, s 1, t 2")));
}

TEST(OpenDriveObjects, BridgesAndTunnelsCoverTheirRoad) {
  const RoadMap road_map = with(R"(<objects><bridge id="b" s="20" length="30" type="concrete"/>
    <tunnel id="t" s="90" length="50" type="standard"/></objects>)");
  ASSERT_EQ(road_map.objects().size(), 2u);
  EXPECT_EQ(road_map.objects()[0].type, "bridge");
  EXPECT_NEAR(geometry::signed_area_m2(road_map.objects()[0].outline_in_map), 210.0, 1e-6);
  EXPECT_EQ(road_map.objects()[1].type, "tunnel");
  EXPECT_NEAR(geometry::signed_area_m2(road_map.objects()[1].outline_in_map), 70.0, 1e-6);
}

TEST(OpenDriveObjects, EndlessRepeatsAreLeftOutAndSaid) {
  const RoadMap road_map = with(R"(<objects><object id="o" type="pole" s="0" t="0" radius="1">
    <repeat s="0" length="1e9" distance="1e-3" tStart="0" tEnd="0"/></object></objects>)");
  EXPECT_LT(road_map.objects().size(), 100'000u);
  EXPECT_THAT(tests::remarks_of(road_map, "import.object"),
              ElementsAre(HasSubstr("more than a map of this size can hold")));
}

TEST(OpenDriveJunctions, PrioritiesBecomeRegulations) {
  MadeRoad other;
  other.id = "B";
  other.x_m = 200.0;
  const RoadMap road_map = with(
      "", made_road(other) + R"(<junction id="J" name=""><priority high="A" low="B"/></junction>)");
  ASSERT_EQ(road_map.regulations().size(), 1u);
  const Regulation& regulation = road_map.regulations()[0];
  EXPECT_EQ(regulation.type, "right_of_way");
  EXPECT_THAT(lane_names(road_map, regulation.lanes), ElementsAre("B/0/1", "B/0/-1"));
  EXPECT_EQ(regulation.members.size(), 4u);
  EXPECT_EQ(regulation.members[0].role, "right_of_way");
  EXPECT_EQ(regulation.members[0].source_id, "A/0/1");
}

}  // namespace
}  // namespace roadbed::map
