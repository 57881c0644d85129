// Links across sections, roads and junctions of all kinds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::lane_of;
using tests::made_lane;
using tests::made_map;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;
using tests::successors_of;

const char* const kFollows = R"(<link><predecessor id="-1"/><successor id="-1"/></link>)";

MadeRoad one_lane(const std::string& id, double x_m, const std::string& link) {
  MadeRoad road;
  road.id = id;
  road.x_m = x_m;
  road.link = link;
  road.lanes = made_section(0, "", made_lane(-1, kFollows));
  return road;
}

// Main road M along x, and C that leaves it at s = 40 and comes back at s = 70.
std::string virtual_junction() {
  MadeRoad main = one_lane("M", 0, "");
  main.lanes = made_section(0, "", made_lane(-1, R"(<roadMark sOffset="0" type="solid"/>
    <roadMark sOffset="50" type="broken"/><speed sOffset="50" max="8"/>)"));
  MadeRoad lane = one_lane("C", 40, R"(
    <predecessor elementType="road" elementId="M" elementS="40" elementDir="+"/>
    <successor elementType="road" elementId="M" elementS="70" elementDir="+"/>)");
  lane.length_m = 30.0;
  return made_road(main) + made_road(lane) +
         R"(<junction id="V" name="" type="virtual" mainRoad="M" sStart="40" sEnd="70" orientation="+">
            <connection id="0" incomingRoad="M" connectingRoad="C" contactPoint="start">
              <laneLink from="-1" to="-1"/></connection></junction>)";
}

TEST(OpenDriveLinks, AVirtualJunctionJoinsItsMainRoadInBetween) {
  const RoadMap road_map = made_map(virtual_junction());
  EXPECT_EQ(road_map.junctions()[0].kind, JunctionKind::virtual_);
  EXPECT_THAT(successors_of(road_map, "M/0/-1"), ElementsAre("M/1/-1", "C/0/-1"));
  EXPECT_THAT(successors_of(road_map, "M/1/-1"), ElementsAre("M/2/-1"));
  EXPECT_THAT(successors_of(road_map, "C/0/-1"), ElementsAre("M/2/-1"));
  EXPECT_THAT(tests::remarks_of(road_map, "import.virtual-junction"),
              ElementsAre(HasSubstr("its 1 lane sections become 3")));
  EXPECT_THAT(tests::remarks_of(road_map, "import.link"), IsEmpty());
}

TEST(OpenDriveLinks, WhatHoldsAlongALaneStaysWhereItWasWhenItIsSplit) {
  const RoadMap road_map = made_map(virtual_junction());
  const Lane& middle = lane_of(road_map, "M/1/-1");  // s = 40 … 70
  EXPECT_NEAR(middle.length_m(), 30.0, 1e-9);
  ASSERT_EQ(middle.right_marks.size(), 2u);
  EXPECT_EQ(middle.right_marks[0].type, MarkType::solid);
  EXPECT_NEAR(middle.right_marks[1].from_s_m, 10.0, 1e-9);
  EXPECT_EQ(middle.speed_limit_at_mps(9.0), std::nullopt);
  EXPECT_EQ(middle.speed_limit_at_mps(11.0), 8.0);
}

TEST(OpenDriveLinks, ElementDirectionSaysWhichPieceIsTouched) {
  std::string document = virtual_junction();
  const std::string from = R"(elementS="40" elementDir="+")";
  document.replace(document.find(from), from.size(), R"(elementS="40" elementDir="-")");
  const RoadMap road_map = made_map(document);
  // Entered against the main road's s: that lane drives the other way.
  EXPECT_THAT(successors_of(road_map, "M/0/-1"), ElementsAre("M/1/-1"));
  EXPECT_THAT(tests::remarks_of(road_map, "import.link"),
              ElementsAre(HasSubstr("end to end against its direction")));
}

TEST(OpenDriveLinks, AVirtualConnectionNeedsNoRoad) {
  const RoadMap road_map =
      made_map(made_road(one_lane("M", 0, "")) + made_road(one_lane("N", 200, "")) +
               R"(<junction id="V" name="" type="virtual"><connection id="0" type="virtual">
         <predecessor elementType="road" elementId="M" elementS="40" elementDir="+"/>
         <successor elementType="road" elementId="N" elementS="70" elementDir="+"/>
         <laneLink from="-1" to="-1"/></connection></junction>)");
  EXPECT_THAT(successors_of(road_map, "M/0/-1"), ElementsAre("M/1/-1", "N/1/-1"));
}

TEST(OpenDriveLinks, ADirectJunctionJoinsRoadsWithoutConnectingRoads) {
  const RoadMap road_map = made_map(
      made_road(one_lane("A", 0, R"(<successor elementType="junction" elementId="J"/>)")) +
      made_road(one_lane("B", 100, R"(<predecessor elementType="junction" elementId="J"/>)")) +
      made_road(one_lane("C", 100, R"(<predecessor elementType="junction" elementId="J"/>)")) +
      R"(<junction id="J" name="" type="direct">
         <connection id="0" incomingRoad="A" linkedRoad="B" contactPoint="start"><laneLink from="-1" to="-1"/></connection>
         <connection id="1" incomingRoad="A" linkedRoad="C" contactPoint="start"><laneLink from="-1" to="-1"/></connection>
         </junction>)");
  EXPECT_EQ(road_map.junctions()[0].kind, JunctionKind::direct);
  EXPECT_THAT(successors_of(road_map, "A/0/-1"), ElementsAre("B/0/-1", "C/0/-1"));
}

TEST(OpenDriveLinks, LanesOfTheOtherSideGoOnOverSingleSidedSections) {
  MadeRoad road =
      one_lane("A", 0, R"(<successor elementType="road" elementId="B" contactPoint="start"/>)");
  const std::string left = made_lane(1, R"(<link><predecessor id="1"/><successor id="1"/></link>)");
  road.lanes = made_section(0, left, made_lane(-1, kFollows)) +
               made_section(30, left, "", "", R"(singleSide="true")") +
               made_section(60, left, "", "", R"(singleSide="true")");
  const RoadMap road_map = made_map(made_road(road) + made_road(one_lane("B", 100, "")));
  EXPECT_NEAR(lane_of(road_map, "A/0/-1").length_m(), 100.0, 1e-9);
  EXPECT_NEAR(lane_of(road_map, "A/1/1").length_m(), 30.0, 1e-9);
  EXPECT_THAT(successors_of(road_map, "A/0/-1"), ElementsAre("B/0/-1"));
  EXPECT_THAT(successors_of(road_map, "A/2/1"), ElementsAre("A/1/1"));
}

TEST(OpenDriveLinks, ASideThatComesBackIsLinkedToTheSectionThatSpokeOfItLast) {
  MadeRoad road = one_lane("A", 0, "");
  const std::string left = made_lane(1, R"(<link><predecessor id="1"/><successor id="1"/></link>)");
  road.lanes = made_section(0, left, made_lane(-1, kFollows)) +
               made_section(30, left, "", "", R"(singleSide="true")") +
               made_section(60, "", made_lane(-1, kFollows), "", R"(singleSide="true")");
  const RoadMap road_map = made_map(made_road(road));
  EXPECT_THAT(successors_of(road_map, "A/0/-1"), ElementsAre("A/2/-1"));
  EXPECT_THAT(tests::remarks_of(road_map, "import.link"), IsEmpty());
}

TEST(OpenDriveLinks, SidewalksAndBordersLinkAtTheEndThatTouches) {
  const auto road = [](const std::string& id, double x_m, const std::string& link) {
    MadeRoad made = one_lane(id, x_m, link);
    const auto lane = [](int lane_id, const char* type) {
      const std::string n = std::to_string(lane_id);
      return made_lane(
          lane_id, R"(<link><predecessor id=")" + n + R"("/><successor id=")" + n + R"("/></link>)",
          type);
    };
    made.lanes = made_section(0, lane(2, "sidewalk") + lane(1, "border"),
                              lane(-1, "border") + lane(-2, "sidewalk"));
    return made_road(made);
  };
  const RoadMap road_map = made_map(
      road("A", 0, R"(<successor elementType="road" elementId="B" contactPoint="start"/>)") +
      road("B", 100, R"(<predecessor elementType="road" elementId="A" contactPoint="end"/>)"));
  for (const char* lane : {"-1", "-2"}) {
    EXPECT_THAT(successors_of(road_map, std::string("A/0/") + lane),
                ElementsAre(std::string("B/0/") + lane));
  }
  for (const char* lane : {"1", "2"}) {
    EXPECT_THAT(successors_of(road_map, std::string("B/0/") + lane),
                ElementsAre(std::string("A/0/") + lane));
    const Lane& from = lane_of(road_map, std::string("B/0/") + lane);
    const Lane& to = lane_of(road_map, std::string("A/0/") + lane);
    EXPECT_NEAR((from.centre.in_map.points().back() - to.centre.in_map.points().front()).norm(),
                0.0, 1e-9);
  }
}

TEST(OpenDriveLinks, DanglingAndCyclicReferencesAreFindings) {
  const RoadMap road_map = made_map(
      made_road(
          one_lane("A", 0, R"(<predecessor elementType="road" elementId="A" contactPoint="end"/>
                                    <successor elementType="road" elementId="A" contactPoint="start"/>)")) +
      R"(<junction id="J" name=""><connection id="0" incomingRoad="A" connectingRoad="Z" contactPoint="start">
         <laneLink from="-1" to="-1"/></connection>
         <connection id="1" incomingRoad="A" connectingRoad="A" contactPoint="start">
         <laneLink from="x" to="-1"/></connection><priority high="Q" low="A"/></junction>)");
  EXPECT_THAT(successors_of(road_map, "A/0/-1"), ElementsAre("A/0/-1"));
  EXPECT_THAT(tests::remarks_of(road_map, "import.link"),
              ElementsAre(HasSubstr("connects road A to road Z")));
  EXPECT_THAT(tests::remarks_of(road_map, "import.junction"),
              ElementsAre(HasSubstr("from=\"x\""), HasSubstr("priority over road A")));
}

}  // namespace
}  // namespace roadbed::map
