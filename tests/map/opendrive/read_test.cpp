#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A straight road along x: 3.5 m lanes 1 (left) and −1, −2 (right), a sidewalk −3.
std::string straight_road(
    const std::string& id, double x_m, const std::string& link, const std::string& attributes = "",
    const std::string& middle_mark = R"(<roadMark sOffset="0" type="solid"/>)",
    const std::string& right_mark = R"(<roadMark sOffset="0" type="broken"/>)") {
  return fmt::format(R"(
 <road id="{0}" length="100" junction="-1" {3}>
  <link>{2}</link>
  <type s="0" type="town"><speed max="50" unit="km/h"/></type>
  <planView><geometry s="0" x="{1}" y="0" hdg="0" length="100"><line/></geometry></planView>
  <lanes><laneSection s="0">
   <left><lane id="1" type="driving"><link><predecessor id="1"/><successor id="1"/></link>
     <width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></left>
   <center><lane id="0" type="none">{4}</lane></center>
   <right>
    <lane id="-1" type="driving"><link><predecessor id="-1"/><successor id="-1"/></link>
     <width sOffset="0" a="3.5" b="0" c="0" d="0"/>{5}</lane>
    <lane id="-2" type="driving"><link><predecessor id="-2"/><successor id="-2"/></link>
     <width sOffset="0" a="3.5" b="0" c="0" d="0"/><speed sOffset="0" max="10"/></lane>
    <lane id="-3" type="sidewalk"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>
   </right>
  </laneSection></lanes>
 </road>)",
                     id, x_m, link, attributes, middle_mark, right_mark);
}

RoadMap parse(const std::string& body) {
  return parse_map("<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" + body + "</OpenDRIVE>",
                   "made.xodr");
}

const Lane& lane(const RoadMap& road_map, const std::string& name) {
  return road_map.lane(road_map.find_lane(name).value());
}

RoadMap two_roads() {
  return parse(
      straight_road("A", 0,
                    R"(<successor elementType="road" elementId="B" contactPoint="start"/>)") +
      straight_road("B", 100,
                    R"(<predecessor elementType="road" elementId="A" contactPoint="end"/>)"));
}

TEST(OpenDrive, RightLanesRunWithTheRoadAndLeftLanesAgainstIt) {
  const RoadMap road_map = two_roads();
  EXPECT_NEAR(lane(road_map, "A/0/-1").pose_at(0).x_m, 0.0, 1e-9);
  EXPECT_NEAR(lane(road_map, "A/0/-1").pose_at(0).y_m, -1.75, 1e-9);
  EXPECT_NEAR(lane(road_map, "A/0/1").pose_at(0).x_m, 100.0, 1e-9);
  EXPECT_NEAR(lane(road_map, "A/0/1").pose_at(0).y_m, 1.75, 1e-9);
  EXPECT_NEAR(std::abs(lane(road_map, "A/0/1").pose_at(50).heading_rad), 3.14159265358979, 1e-9);
}

TEST(OpenDrive, LeftBorderIsLeftInDrivingDirection) {
  const RoadMap road_map = two_roads();
  for (const char* name : {"A/0/1", "A/0/-1", "A/0/-2"}) {
    const Lane& item = lane(road_map, name);
    EXPECT_NEAR(item.centre.in_map.project(Lane::point_at(item.left, 50)).d_m, 1.75, 1e-9) << name;
    EXPECT_NEAR(item.centre.in_map.project(Lane::point_at(item.right, 50)).d_m, -1.75, 1e-9)
        << name;
    EXPECT_NEAR(geometry::signed_area_m2(item.polygon), 350.0, 1e-9) << name;
  }
}

TEST(OpenDrive, SuccessorsFollowTheDrivingDirection) {
  const RoadMap road_map = two_roads();
  const auto successors = [&](const char* name) {
    std::vector<std::string> names;
    for (const LaneId id : road_map.graph().of(*road_map.find_lane(name)).successors) {
      names.push_back(road_map.lane(id).name);
    }
    return names;
  };
  EXPECT_THAT(successors("A/0/-1"), ElementsAre("B/0/-1"));
  EXPECT_THAT(successors("B/0/1"), ElementsAre("A/0/1"));
  EXPECT_THAT(successors("B/0/-1"), ElementsAre());
  EXPECT_THAT(successors("A/0/1"), ElementsAre());
}

TEST(OpenDrive, NeighboursAreLeftAndRightOfTheDriver) {
  const RoadMap road_map = two_roads();
  const LaneLinks& inner = road_map.graph().of(*road_map.find_lane("A/0/-1"));
  ASSERT_TRUE(inner.left && inner.right);
  EXPECT_EQ(road_map.lane(inner.left->lane).name, "A/0/1");
  EXPECT_FALSE(inner.left->same_direction);
  EXPECT_FALSE(inner.left->change_allowed());  // solid
  EXPECT_EQ(road_map.lane(inner.right->lane).name, "A/0/-2");
  EXPECT_TRUE(inner.right->same_direction);
  EXPECT_TRUE(inner.right->change_allowed());  // broken
  const LaneLinks& oncoming = road_map.graph().of(*road_map.find_lane("A/0/1"));
  ASSERT_TRUE(oncoming.left);
  EXPECT_EQ(road_map.lane(oncoming.left->lane).name, "A/0/-1");
  EXPECT_FALSE(oncoming.right);
}

TEST(OpenDrive, OneSidedMarkingAllowsTheChangeFromItsBrokenSideOnly) {
  // Lane −1's outer marking: "broken solid" is broken for who drives inside.
  const RoadMap road_map =
      parse(straight_road("A", 0, "", "", "", R"(<roadMark sOffset="0" type="broken solid"/>)"));
  EXPECT_TRUE(road_map.graph().of(*road_map.find_lane("A/0/-1")).right->change_allowed());
  EXPECT_FALSE(road_map.graph().of(*road_map.find_lane("A/0/-2")).left->change_allowed());
}

TEST(OpenDrive, LaneChangeAttributeOverridesTheLineType) {
  // "increase": only towards larger ids, that is from −2 to −1.
  const RoadMap road_map = parse(straight_road(
      "A", 0, "", "", "", R"(<roadMark sOffset="0" type="solid" laneChange="increase"/>)"));
  EXPECT_FALSE(road_map.graph().of(*road_map.find_lane("A/0/-1")).right->change_allowed());
  EXPECT_TRUE(road_map.graph().of(*road_map.find_lane("A/0/-2")).left->change_allowed());
}

TEST(OpenDrive, LeftHandTrafficTurnsDirectionsRound) {
  const RoadMap road_map = parse(straight_road("A", 0, "", "rule=\"LHT\""));
  const Lane& right = lane(road_map, "A/0/-1");
  EXPECT_NEAR(right.pose_at(0).x_m, 100.0, 1e-9);
  EXPECT_NEAR(right.centre.in_map.project(Lane::point_at(right.left, 50)).d_m, 1.75, 1e-9);
  EXPECT_NEAR(Lane::point_at(right.right, 50).y(), 0.0, 1e-9);  // nearer the reference line
}

TEST(OpenDrive, ALanesOwnSpeedLimitOverridesTheRoads) {
  const RoadMap road_map = two_roads();
  EXPECT_NEAR(lane(road_map, "A/0/-1").speed_limit_at_mps(0.0).value(), 50.0 / 3.6, 1e-12);
  EXPECT_NEAR(lane(road_map, "A/0/-2").speed_limit_at_mps(0.0).value(), 10.0, 1e-12);
}

TEST(OpenDrive, ALinkToAMissingRoadIsRemarkedNotRefused) {
  const RoadMap road_map = parse(straight_road(
      "A", 0, R"(<successor elementType="road" elementId="99" contactPoint="start"/>)"));
  const auto fault =
      std::find_if(road_map.import_diagnostics().begin(), road_map.import_diagnostics().end(),
                   [](const ImportDiagnostic& r) { return r.is_fault; });
  ASSERT_NE(fault, road_map.import_diagnostics().end());
  EXPECT_THAT(fault->message, HasSubstr("road 99"));
  EXPECT_EQ(fault->element, "road A");
}

TEST(OpenDrive, FarCoordinatesAreKeptNearALocalOriginAndComeBackExactly) {
  const RoadMap road_map = parse(straight_road("A", 5'400'000.25, ""));
  EXPECT_LT(lane(road_map, "A/0/-1").pose_at(0).x_m, 1000.0);
  const Eigen::Vector2d start = lane(road_map, "A/0/-1").pose_at(0).position();
  EXPECT_EQ(road_map.to_source(start).x(), 5'400'000.25);
}

TEST(OpenDrive, SuperelevationTurnsTheCrossSectionAboutTheReferenceLine) {
  std::string road = straight_road("A", 0, "");
  road.insert(
      road.find("<lanes>"),
      R"(<lateralProfile><superelevation s="0" a="0.1" b="0" c="0" d="0"/></lateralProfile>)");
  const RoadMap road_map = parse(road);
  const Lane& item = lane(road_map, "A/0/-2");
  EXPECT_NEAR(Lane::point_at(item.right, 50).y(), -7.0 * std::cos(0.1), 1e-9);
  EXPECT_NEAR(item.right.z_m.front(), -7.0 * std::sin(0.1), 1e-9);
}

std::string refusal(const std::string& bytes) {
  return tests::refusal_of([&] { parse_map(bytes, "made.xodr"); });
}

TEST(OpenDrive, UnusableFilesAreRefusedOnOneLineWithTheirPlace) {
  const std::string good = "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" +
                           straight_road("A", 0, "") + "</OpenDRIVE>";
  const auto replaced = [&](const std::string& what, const std::string& with) {
    std::string changed = good;
    changed.replace(changed.find(what), what.size(), with);
    return changed;
  };
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_THAT(refusal(replaced("hdg=\"0\"", "hdg=\"nan\"")),
              HasSubstr("made.xodr:5: <geometry> of road A: hdg=\"nan\", needs a finite number"));
  EXPECT_THAT(refusal(replaced("length=\"100\" junction", "length=\"1e999\" junction")),
              HasSubstr("made.xodr:2: <road> of road A: length=\"1e999\""));
  EXPECT_THAT(refusal(replaced("<line/>", "<circle/>")), HasSubstr("no known curve"));
  EXPECT_THAT(refusal(replaced("x=\"0\"", "x=\"1e308\"")), HasSubstr("beyond that of any road"));
  EXPECT_THAT(refusal(replaced("<line/>", "<arc curvature=\"1e3\"/>")),
              HasSubstr("beyond that of any road"));
  EXPECT_THAT(refusal(replaced("<line/>",
                               "<paramPoly3 aU=\"0\" bU=\"100\" cU=\"1e7\" dU=\"-1e7\" aV=\"0\" "
                               "bV=\"0\" cV=\"0\" dV=\"0\" pRange=\"normalized\"/>")),
              HasSubstr("beyond that of any road"));
  EXPECT_THAT(refusal(replaced("a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"",
                               "a=\"3.5\" b=\"0\" c=\"0\" d=\"1e200\"")),
              HasSubstr("made.xodr:2: road A: "));
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2)), HasSubstr("not well-formed XML"));
  EXPECT_THAT(refusal("<kml/>"), HasSubstr("root element <kml>"));
  EXPECT_THAT(refusal("what?"), HasSubstr("neither XML nor a compiled map"));
  EXPECT_THAT(refusal("<OpenDRIVE/>"), HasSubstr("no road with a geometry"));
}

// The same file with another name space for the root, or for all.
std::string prefixed(std::string text, bool all) {
  for (const std::string_view open : {"</", "<"}) {
    for (std::size_t at = text.find(open); at != text.npos; at = text.find(open, at + 1)) {
      const std::size_t name = at + open.size();
      const bool is_root = text.compare(name, 9, "OpenDRIVE") == 0;
      if (text[name] != '/' && text[name] != 'o' && (all || is_root)) text.insert(name, "o:");
    }
  }
  return text.insert(text.find("o:OpenDRIVE") + 11, " xmlns:o=\"opendrive_schema\"");
}

TEST(OpenDrive, PrefixesOfTheNamespaceChangeNothing) {
  const std::string good = "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" +
                           straight_road("A", 0, "") + "</OpenDRIVE>";
  const RoadMap expected = parse_map(good, "made.xodr");
  for (const bool all : {false, true}) {
    const RoadMap road_map = parse_map(prefixed(good, all), "made.xodr");
    EXPECT_EQ(road_map.lanes().size(), 4u);
    EXPECT_EQ(road_map.format(), "OpenDRIVE 1.6");
    EXPECT_EQ(lane(road_map, "A/0/-3").left.in_map.points(),
              lane(expected, "A/0/-3").left.in_map.points());
  }
  EXPECT_THAT(refusal(prefixed("<OpenDRIVE>\n<road id=\"1\" length=\"x\"/></OpenDRIVE>", true)),
              HasSubstr("made.xodr:2: <road> of road 1: length=\"x\""));
}

std::vector<std::string> remarked(const RoadMap& road_map) {
  std::vector<std::string> rules;
  for (const ImportDiagnostic& remark : road_map.import_diagnostics()) {
    if (remark.is_fault) rules.push_back(remark.rule);
  }
  return rules;
}

TEST(OpenDrive, OfTwoRoadsWithOneIdTheFirstIsTaken) {
  const RoadMap road_map =
      parse(straight_road("A", 0, "") + straight_road("A", 500, "") + straight_road("B", 900, ""));
  EXPECT_EQ(road_map.roads().size(), 2u);
  EXPECT_NEAR(lane(road_map, "A/0/-1").centre.in_map.points().front().x(), 0.0, 1e-12);
  EXPECT_THAT(remarked(road_map), ElementsAre("import.duplicate-road"));
}

TEST(OpenDrive, OfTwoLanesWithOneIdTheFirstIsTaken) {
  std::string twice = straight_road("A", 0, "");
  twice.replace(twice.find("id=\"-3\""), 7, "id=\"-2\"");
  const RoadMap road_map = parse(twice);
  EXPECT_EQ(road_map.lanes().size(), 3u);
  EXPECT_EQ(lane(road_map, "A/0/-2").type, LaneType::driving);
  EXPECT_THAT(remarked(road_map), ElementsAre("import.duplicate-lane"));
}

TEST(OpenDrive, EntitiesAreNotExpanded) {
  const std::string bomb =
      "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><OpenDRIVE>" +
      straight_road("A", 0, "") + "<road id=\"&b;\" length=\"0\"/></OpenDRIVE>";
  EXPECT_EQ(refusal(bomb), "accepted");
}

}  // namespace
}  // namespace roadbed::map
