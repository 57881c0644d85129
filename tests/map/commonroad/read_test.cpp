#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

RoadMap junction() { return load_map(tests::data_folder() / "junction.xml"); }

const Lane& lane(const RoadMap& road_map, const std::string& name) {
  return road_map.lane(road_map.find_lane(name).value());
}

std::vector<std::string> names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::vector<std::string> found;
  for (const LaneId id : lanes) found.push_back(road_map.lane(id).name);
  return found;
}

const LaneLinks& links(const RoadMap& road_map, const std::string& name) {
  return road_map.graph().of(lane(road_map, name).id);
}

std::vector<std::string> rules(const RoadMap& road_map) {
  std::vector<std::string> found;
  for (const ImportDiagnostic& remark : road_map.import_diagnostics()) {
    if (remark.is_fault) found.push_back(remark.rule);
  }
  return found;
}

std::string bound(const std::string& name, const std::vector<Eigen::Vector2d>& points,
                  const std::string& marking) {
  std::string text = "<" + name + ">";
  for (const auto& p : points) {
    text += fmt::format("<point><x>{}</x><y>{}</y></point>", p.x(), p.y());
  }
  if (!marking.empty()) text += "<lineMarking>" + marking + "</lineMarking>";
  return text + "</" + name + ">";
}

// A lanelet along x from x0 to x1, right border at y, 3 m wide.
std::string lanelet(const std::string& id, double x0, double x1, double y, const std::string& rest,
                    const std::string& left = "", const std::string& right = "") {
  const double width = x1 > x0 ? 3.0 : -3.0;
  return "<lanelet id=\"" + id + "\">" +
         bound("leftBound", {{x0, y + width}, {x1, y + width}}, left) +
         bound("rightBound", {{x0, y}, {x1, y}}, right) + rest + "</lanelet>";
}

RoadMap parse(const std::string& body, const std::string& version = "2020a",
              const std::string& benchmark = "DEU_Made-1_1_T-1") {
  return parse_map("<commonRoad commonRoadVersion=\"" + version + "\" benchmarkID=\"" + benchmark +
                       "\" timeStepSize=\"0.1\">" + body + "</commonRoad>",
                   "made.xml");
}

TEST(CommonRoad, NamesFormatAndFileAttributes) {
  const RoadMap road_map = junction();
  EXPECT_EQ(road_map.format(), "CommonRoad 2020a");
  EXPECT_EQ(road_map.crs(), "");
  EXPECT_THAT(road_map.attributes(), testing::Contains(Pair("gpsLatitude", "999")));
  EXPECT_THAT(road_map.attributes(), testing::Contains(Pair("author", "roadbed")));
  EXPECT_THAT(rules(road_map), IsEmpty());
  EXPECT_THAT(road_map.unused(), IsEmpty());
}

/// What is no number is not there, for who writes the map again either.
TEST(CommonRoad, WhereTheirSystemHasTheCoordinatesIsSaidOnce) {
  const RoadMap road_map = parse(
      "<location><geoTransformation><geoReference>EPSG:25832</geoReference>"
      "<additionalTransformation><xTranslation>500.5</xTranslation>"
      "<yTranslation>far</yTranslation><zRotation>0.25</zRotation><scaling>2</scaling>"
      "</additionalTransformation></geoTransformation></location>" +
      lanelet("1", 0, 50, 0, ""));
  EXPECT_EQ(road_map.offset_in_crs(), (CrsOffset{.x_m = 500.5, .heading_rad = 0.25}));
  EXPECT_THAT(rules(road_map),
              ElementsAre("import.geo-transformation", "import.geo-transformation"));
  for (const auto& [name, value] : road_map.attributes()) {
    EXPECT_FALSE(name.ends_with("Translation") || name == "zRotation") << name;
  }
}

TEST(CommonRoad, BordersAreThePointsOfTheFileAndTheCentreIsHalfway) {
  const RoadMap road_map = junction();
  ASSERT_THAT(road_map.lanes(), SizeIs(12));
  const Lane& first = lane(road_map, "1");
  ASSERT_THAT(first.left.in_map.points(), SizeIs(6));
  EXPECT_EQ(first.left.in_map.points()[2], Eigen::Vector2d(20, 0));
  EXPECT_EQ(first.right.in_map.points()[5], Eigen::Vector2d(50, -3.5));
  EXPECT_EQ(first.centre.in_map.points()[5], Eigen::Vector2d(50, -1.75));
  EXPECT_NEAR(geometry::signed_area_m2(first.polygon), 175.0, 1e-9);
  // The quarter turn: its centreline is an arc of radius 6.75 m in eight chords.
  EXPECT_NEAR(lane(road_map, "4").length_m(), 8 * 2 * 6.75 * std::sin(0.5 * M_PI / 16), 1e-5);
}

TEST(CommonRoad, LinksHoldInBothDirections) {
  const RoadMap road_map = junction();
  EXPECT_THAT(names(road_map, links(road_map, "1").successors), ElementsAre("21", "4"));
  EXPECT_THAT(names(road_map, links(road_map, "21").predecessors), ElementsAre("1"));
  EXPECT_THAT(names(road_map, links(road_map, "13").successors), ElementsAre("23"));
  EXPECT_EQ(road_map.lane(links(road_map, "2").left->lane).name, "3");
  EXPECT_FALSE(links(road_map, "2").left->same_direction);
  EXPECT_EQ(road_map.lane(links(road_map, "3").left->lane).name, "2");
  EXPECT_TRUE(links(road_map, "2").right->same_direction);
}

TEST(CommonRoad, MarkingsSayWhereLanesMayBeChanged) {
  const RoadMap road_map = junction();
  EXPECT_THAT(links(road_map, "1").left->change_windows, ElementsAre(StationRange{0.0, 50.0}));
  EXPECT_TRUE(links(road_map, "2").right->change_allowed());
  EXPECT_FALSE(links(road_map, "2").left->change_allowed()) << "double solid";
  EXPECT_TRUE(links(road_map, "21").left->change_allowed()) << "no marking";
}

TEST(CommonRoad, OfADoubleLineTheOneNearerToTheDriverCounts) {
  const RoadMap road_map = parse(
      lanelet("1", 0, 50, 0, R"(<adjacentLeft ref="2" drivingDir="same"/>)", "dashed_solid") +
      lanelet("2", 0, 50, 3, R"(<adjacentRight ref="1" drivingDir="same"/>)", "", "dashed_solid"));
  EXPECT_FALSE(links(road_map, "1").left->change_allowed()) << "solid line on its side";
  EXPECT_TRUE(links(road_map, "2").right->change_allowed()) << "dashed line on its side";
}

TEST(CommonRoad, AMarkingOfTheNeighbourCountsWhereALaneHasNone) {
  const std::string beside = R"(<adjacentRight ref="1" drivingDir="same"/>)";
  const std::string own = R"(<adjacentLeft ref="2" drivingDir="same"/>)";
  for (const auto& [marking, allowed] :
       {std::pair("solid", false), std::pair("dashed", true), std::pair("unknown", true)}) {
    const RoadMap road_map =
        parse(lanelet("1", 0, 50, 0, own) + lanelet("2", 0, 50, 3, beside, "", marking));
    EXPECT_EQ(links(road_map, "1").left->change_allowed(), allowed) << marking;
  }
}

TEST(CommonRoad, AnUnmarkedOncomingLaneIsNotChangedTo) {
  const RoadMap road_map =
      parse(lanelet("1", 0, 50, 0, R"(<adjacentLeft ref="2" drivingDir="opposite"/>)") +
            lanelet("2", 50, 0, 6, R"(<adjacentLeft ref="1" drivingDir="opposite"/>)"));
  EXPECT_FALSE(links(road_map, "1").left->same_direction);
  EXPECT_FALSE(links(road_map, "1").left->change_allowed());
  EXPECT_THAT(rules(road_map), IsEmpty());
}

TEST(CommonRoad, LanesAreChangedOnlyWhereTheirBordersRunTogether) {
  const std::string fork = "<lanelet id=\"2\">" +
                           bound("leftBound", {{0, 6}, {30, 6}, {60, 16}}, "") +
                           bound("rightBound", {{0, 3}, {30, 3}, {60, 13}}, "") + "</lanelet>";
  const std::string straight = "<lanelet id=\"1\">" +
                               bound("leftBound", {{0, 3}, {30, 3}, {60, 3}}, "dashed") +
                               bound("rightBound", {{0, 0}, {30, 0}, {60, 0}}, "") +
                               "<adjacentLeft ref=\"2\" drivingDir=\"same\"/></lanelet>";
  const RoadMap road_map = parse(straight + fork);
  EXPECT_THAT(links(road_map, "1").left->change_windows, ElementsAre(StationRange{0.0, 30.0}));
}

TEST(CommonRoad, LinksThatContradictGeometryAreRemarked) {
  const RoadMap road_map =
      parse(lanelet("1", 0, 50, 0,
                    R"(<successor ref="2"/><adjacentLeft ref="3" drivingDir="opposite"/>)") +
            lanelet("2", 60, 90, 0, R"(<predecessor ref="1"/>)") + lanelet("3", 0, 50, 3, ""));
  EXPECT_THAT(rules(road_map),
              ElementsAre("import.link-geometry", "import.link-geometry", "import.link-geometry"));
  EXPECT_THAT(links(road_map, "1").successors, IsEmpty());
  EXPECT_FALSE(links(road_map, "1").left->change_allowed());
}

TEST(CommonRoad, OneSidedAndDanglingLinksAreRemarked) {
  const RoadMap road_map = parse(lanelet("1", 0, 50, 0, R"(<successor ref="2"/>)") +
                                 lanelet("2", 50, 90, 0, R"(<successor ref="7"/>)"));
  EXPECT_THAT(rules(road_map), ElementsAre("import.link", "import.one-sided-link"));
  EXPECT_THAT(names(road_map, links(road_map, "2").predecessors), ElementsAre("1"));
}

TEST(CommonRoad, TypesAndUsersSayWhoMayUseALane) {
  const RoadMap road_map = junction();
  EXPECT_EQ(lane(road_map, "1").type, LaneType::driving);
  EXPECT_EQ(lane(road_map, "1").participants, Participants::vehicles());
  EXPECT_EQ(lane(road_map, "5").participants, Participants{Participant::car});
  EXPECT_EQ(lane(road_map, "6").type, LaneType::biking);
  const RoadMap made = parse(
      lanelet("1", 0, 9, 0, "<userBidirectional>vehicle</userBidirectional>") +
      lanelet("2", 0, 9, 3, "<laneletType>urban</laneletType><userOneWay>bicycle</userOneWay>") +
      lanelet("3", 0, 9, 6, "<laneletType>highway</laneletType><userOneWay>bus</userOneWay>") +
      lanelet("4", 0, 9, 9, "<laneletType>crosswalk</laneletType>"));
  EXPECT_FALSE(lane(made, "1").one_way);
  EXPECT_EQ(lane(made, "1").type, LaneType::driving);
  EXPECT_EQ(lane(made, "2").type, LaneType::biking);
  EXPECT_EQ(lane(made, "3").type, LaneType::bus);
  EXPECT_EQ(lane(made, "4").type, LaneType::sidewalk);
  EXPECT_EQ(lane(made, "4").participants, Participants{Participant::pedestrian});
}

std::string limit_sign(const std::string& id, const std::string& type, double mps) {
  return fmt::format(
      "<trafficSign id=\"{}\"><trafficSignElement><trafficSignID>{}</trafficSignID>"
      "<additionalValue>{}</additionalValue></trafficSignElement></trafficSign>",
      id, type, mps);
}

TEST(CommonRoad, SpeedLimitsFollowTheCountrysSigns) {
  const std::string road = lanelet("1", 0, 9, 0, R"(<trafficSignRef ref="5"/>)");
  const auto limit = [&](const std::string& benchmark, const std::string& type) {
    const RoadMap road_map = parse(road + limit_sign("5", type, 12.5), "2020a", benchmark);
    return lane(road_map, "1").speed_limit_at_mps(0.0);
  };
  EXPECT_EQ(limit("DEU_Made-1", "274"), 12.5);
  EXPECT_EQ(limit("USA_Made-1", "R2-1"), 12.5);
  EXPECT_EQ(limit("C-BEL_Made-1", "C43"), 12.5);
  EXPECT_EQ(limit("GRC_Made-1", "Ρ-32"), 12.5);
  EXPECT_EQ(limit("HRV_Made-1", "274"), 12.5) << "older files write Germany's everywhere";
  EXPECT_EQ(limit("DEU_Made-1", "R2-1"), std::nullopt);
}

TEST(CommonRoad, OfSeveralSpeedLimitsTheLeastHolds) {
  const RoadMap road_map =
      parse(lanelet("1", 0, 9, 0, R"(<trafficSignRef ref="5"/><trafficSignRef ref="6"/>)") +
            limit_sign("5", "274", 10.0) + limit_sign("6", "274", 8.0));
  EXPECT_EQ(lane(road_map, "1").speed_limit_at_mps(5.0), 8.0);
  EXPECT_EQ(road_map.signals().front().unit, "m/s");
}

TEST(CommonRoad, OldFilesGiveTheSpeedLimitOnTheLanelet) {
  const RoadMap road_map =
      parse(lanelet("1", 0, 9, 0, "<speedLimit>23</speedLimit>"), "2018b", "ZAM_Over-1_1");
  EXPECT_EQ(road_map.format(), "CommonRoad 2018b");
  EXPECT_EQ(lane(road_map, "1").speed_limit_at_mps(0.0), 23.0);
}

TEST(CommonRoad, LightsKeepTheirCycle) {
  const RoadMap road_map = junction();
  ASSERT_THAT(road_map.signals(), SizeIs(2));
  const Signal& light = road_map.signals()[1];
  EXPECT_TRUE(light.dynamic);
  EXPECT_EQ(light.in_map, Eigen::Vector2d(51, -4));
  EXPECT_THAT(names(road_map, light.lanes), ElementsAre("1"));
  EXPECT_THAT(
      light.attributes,
      ElementsAre(Pair("cycleElement", "red 60"), Pair("cycleElement", "redYellow 10"),
                  Pair("cycleElement", "green 60"), Pair("cycleElement", "yellow 10"),
                  Pair("timeOffset", "20"), Pair("direction", "all"), Pair("active", "true")));
}

TEST(CommonRoad, AStopLineWithoutPointsLiesAcrossTheLaneletsEnd) {
  const RoadMap road_map =
      parse(lanelet("1", 0, 9, 0, "<stopLine><lineMarking>solid</lineMarking></stopLine>"));
  ASSERT_THAT(road_map.stop_lines(), SizeIs(1));
  EXPECT_THAT(road_map.stop_lines()[0].in_map,
              ElementsAre(Eigen::Vector3d(9, 3, 0), Eigen::Vector3d(9, 0, 0)));
  EXPECT_THAT(junction().stop_lines()[0].signals, ElementsAre("51"));
}

TEST(CommonRoad, AStopLineWithoutReferencesHoldsForTheLightsAndSignsOfItsLanelet) {
  const auto held_for = [](const std::string& in_line) {
    const std::string refs = R"(<trafficSignRef ref="8"/><trafficLightRef ref="9"/>)";
    return parse(lanelet("1", 0, 9, 0, "<stopLine>" + in_line + "</stopLine>" + refs) +
                 R"(<trafficSign id="7"/><trafficSign id="8"/><trafficLight id="9"/>)")
        .stop_lines()[0]
        .signals;
  };
  EXPECT_THAT(held_for(""), ElementsAre("8", "9"));
  EXPECT_THAT(held_for(R"(<trafficSignRef ref="7"/>)"), ElementsAre("7", "9"));
  EXPECT_THAT(held_for(R"(<trafficLightRef ref="9"/>)"), ElementsAre("9"));
}

TEST(CommonRoad, IntersectionsBecomeRegulationsAndJunctions) {
  const RoadMap road_map = junction();
  ASSERT_THAT(road_map.regulations(), SizeIs(1));
  const Regulation& rule = road_map.regulations()[0];
  EXPECT_EQ(rule.type, "intersection");
  EXPECT_THAT(names(road_map, rule.lanes), ElementsAre("1", "2", "13"));
  EXPECT_EQ(rule.members[2].role, "successors_right");
  EXPECT_EQ(rule.members[2].source_id, "4");
  EXPECT_THAT(rule.members[2].attributes, ElementsAre(Pair("incoming", "61")));
  for (const char* inside : {"4", "21", "22", "23"}) {
    EXPECT_EQ(lane(road_map, inside).junction, JunctionId{0}) << inside;
  }
  EXPECT_FALSE(lane(road_map, "1").junction);
}

TEST(CommonRoad, ElevationAndFarCoordinatesAreKept) {
  const std::string far =
      "<lanelet id=\"1\"><leftBound><point><x>500000.5</x><y>5400003</y><z>7</z></point>"
      "<point><x>500010.5</x><y>5400003</y><z>8</z></point></leftBound><rightBound><point><x>"
      "500000.5</x><y>5400000</y><z>7</z></point><point><x>500010.5</x><y>5400000</y><z>9</z>"
      "</point></rightBound></lanelet>";
  const RoadMap road_map = parse(far);
  const Lane& only = lane(road_map, "1");
  EXPECT_EQ(road_map.origin_in_source(), Eigen::Vector2d(500000, 5400000));
  EXPECT_EQ(road_map.to_source(only.left.in_map.points()[0]), Eigen::Vector2d(500000.5, 5400003));
  EXPECT_THAT(only.centre.z_m, ElementsAre(7.0, 8.5));
}

TEST(CommonRoad, BordersOfUnequalNumbersOfPointsKeepAllTheirPoints) {
  const RoadMap road_map =
      parse("<lanelet id=\"1\">" + bound("leftBound", {{0, 3}, {4, 3}, {10, 3}}, "") +
            bound("rightBound", {{0, 0}, {10, 0}}, "") + "</lanelet>");
  EXPECT_THAT(lane(road_map, "1").right.in_map.points(),
              ElementsAre(Eigen::Vector2d(0, 0), Eigen::Vector2d(4, 0), Eigen::Vector2d(10, 0)));
  EXPECT_THAT(rules(road_map), ElementsAre("import.border-points"));
}

TEST(CommonRoad, BrokenLaneletsAreLeftOutAndTheOthersKept) {
  const std::string good = lanelet("1", 0, 9, 0, "");
  const RoadMap road_map = parse(
      good + lanelet("1", 0, 9, 3, "") + "<lanelet id=\"2\">" + bound("leftBound", {{0, 3}}, "") +
      bound("rightBound", {{0, 0}, {1, 0}}, "") + "</lanelet>" + lanelet("3", 5, 5, 0, ""));
  EXPECT_THAT(road_map.lanes(), SizeIs(1));
  EXPECT_THAT(rules(road_map),
              ElementsAre("import.lanelet-id", "import.short-border", "import.empty-lanelet"));
}

TEST(CommonRoad, SwappedBordersAreRemarked) {
  const RoadMap road_map = parse("<lanelet id=\"1\">" + bound("leftBound", {{0, 0}, {9, 0}}, "") +
                                 bound("rightBound", {{0, 3}, {9, 3}}, "") + "</lanelet>");
  EXPECT_THAT(rules(road_map), ElementsAre("import.swapped-borders"));
}

TEST(CommonRoad, UnknownElementsAreCounted) {
  const RoadMap road_map = parse(lanelet("1", 0, 9, 0, "<speedBump/><speedBump/>") + "<weather/>");
  ASSERT_THAT(road_map.unused(), SizeIs(2));
  EXPECT_EQ(road_map.unused()[0].name, "commonRoad/weather");
  EXPECT_EQ(road_map.unused()[1].name, "lanelet/speedBump");
  EXPECT_EQ(road_map.unused()[1].count, 2U);
}

std::string message_of(const std::string& body, const std::string& version = "2020a") {
  return tests::refusal_of([&] { parse(body, version); });
}

TEST(CommonRoad, UnusableFilesAreRefusedWithTheirPlace) {
  EXPECT_THAT(message_of(lanelet("1", 0, 9, 0, ""), "2017a"), HasSubstr("2017a"));
  EXPECT_THAT(message_of(""), HasSubstr("no usable lanelet"));
  EXPECT_THAT(message_of("\n\n<lanelet id=\"8\"><leftBound><point><x>nan</x><y>0</y></point>"
                         "</leftBound></lanelet>"),
              testing::AllOf(HasSubstr("made.xml:3"), HasSubstr("nan"), HasSubstr("lanelet 8")));
  EXPECT_THAT(message_of(lanelet("1", 0, 1e300, 0, "")), HasSubstr("beyond"));
  EXPECT_THAT(message_of("<lanelet id=\"8\"><leftBound><point><x>1</x></point></leftBound>"
                         "</lanelet>"),
              HasSubstr("<y> is missing"));
}

}  // namespace
}  // namespace roadbed::map
