// Rules about a map whatever its format: each silent on a faultless map, and speaking up where one
// thing in it is changed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "roadbed/map/validation/validate.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::validation {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using tests::MadeMap;

std::vector<Finding> of_rule(const MadeMap& made, const std::string& rule) {
  auto findings = validate(made.build());
  std::erase_if(findings, [&](const Finding& finding) { return finding.rule != rule; });
  return findings;
}

/// Lanes 1/0/-1 and 2/0/-1 eastwards, one behind the other, with 1/0/-2 to the right of the first,
/// a light, a stop line, a regulation, a CRS and limits: nothing to complain of but loose ends.
MadeMap faultless() {
  MadeMap made;
  made.parts.format = "made";
  made.parts.crs = "EPSG:25832";
  const RoadId first = made.add_road("1"), second = made.add_road("2");
  const LaneId a = made.add_lane(first, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId b = made.add_lane(first, "-2", {{0, 0}, {50, 0}}, {{0, -3}, {50, -3}});
  const LaneId c = made.add_lane(second, "-1", {{50, 3}, {90, 3}}, {{50, 0}, {90, 0}});
  made.put_beside(a, b);
  made.link(a, c);
  Signal light;
  light.source_id = "5";
  light.in_map = {50, -4};
  light.dynamic = true;
  light.lanes = {a};
  made.parts.signals.push_back(light);
  made.parts.stop_lines.push_back({"6", {{49, 3, 0}, {49, 0, 0}}, {a}, {"5"}});
  Regulation rule;
  rule.source_id = "7";
  rule.type = "right_of_way";
  rule.lanes = {a};
  made.parts.regulations.push_back(rule);
  MapObject pole;
  pole.source_id = "8";
  pole.in_map = {20, 6};
  made.parts.objects.push_back(pole);
  return made;
}

constexpr LaneId kA{0}, kB{1}, kC{2};

void move(Lane& lane, const Eigen::Vector2d& by) {
  for (LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
    Points points = line->in_map.points();
    for (Eigen::Vector2d& point : points) point += by;
    line->in_map = geometry::Polyline(points);
  }
}

/// The same lane in the opposite direction.
void turn_round(Lane& lane) {
  for (LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
    Points points = line->in_map.points();
    std::reverse(points.begin(), points.end());
    line->in_map = geometry::Polyline(points);
  }
  std::swap(lane.left, lane.right);
}

/// A lane of its own road along a quarter circle of that radius, far from the others.
LaneId add_bend(MadeMap& made, double radius_m) {
  Points left, right;
  for (int i = 0; i <= 60; ++i) {
    const Eigen::Vector2d outwards(std::cos(0.025 * i), std::sin(0.025 * i));
    left.push_back(Eigen::Vector2d(0, 500) + (radius_m - 1.0) * outwards);
    right.push_back(Eigen::Vector2d(0, 500) + (radius_m + 1.0) * outwards);
  }
  return made.add_lane(made.add_road("9"), "-1", left, right);
}

struct Slip {
  std::string rule;
  std::function<void(MadeMap&)> make;
};

std::vector<Slip> slips() {
  return {
      {"geometry.gap",
       [](MadeMap& made) {
         move(made.lane(kC), {0, 0.1});
       }},
      {"geometry.kink",
       [](MadeMap& made) {
         Lane& lane = made.lane(kC);
         lane.left.in_map = geometry::Polyline({{50, 3}, {90, 7.5}});
         lane.centre.in_map = geometry::Polyline({{50, 1.5}, {90, 6}});
         lane.right.in_map = geometry::Polyline({{50, 0}, {90, 4.5}});
       }},
      {"geometry.elevation-step",
       [](MadeMap& made) {
         made.lane(kC).centre.z_m = {1, 1};
       }},
      {"geometry.slope-jump",
       [](MadeMap& made) {
         made.lane(kC).centre.z_m = {0, 8};
       }},
      {"link.reversed", [](MadeMap& made) { turn_round(made.lane(kC)); }},
      {"link.wrong-end", [](MadeMap& made) { turn_round(made.lane(kC)); }},
      {"geometry.negative-width",
       [](MadeMap& made) { std::swap(made.lane(kA).left, made.lane(kA).right); }},
      {"geometry.zero-width", [](MadeMap& made) { made.lane(kA).left = made.lane(kA).right; }},
      {"geometry.absurd-width",
       [](MadeMap& made) {
         made.lane(kA).left.in_map = geometry::Polyline({{0, 53}, {50, 53}});
       }},
      {"geometry.fold",
       [](MadeMap& made) {
         Lane& lane = made.lane(kA);
         lane.left = {geometry::Polyline({{0, 3}, {30, 3}, {29, 3}, {50, 3}}),
                      {0, 0, 0, 0},
                      {0, 29.5, 29.6, 50}};
       }},
      {"geometry.self-intersection",
       [](MadeMap& made) {
         made.add_lane(made.add_road("9"), "-1",
                       {{0, 501}, {41, 501}, {41, 531}, {19, 531}, {19, 470}},
                       {{0, 499}, {43, 499}, {43, 533}, {17, 533}, {17, 470}});
       }},
      {"geometry.short-lane",
       [](MadeMap& made) {
         made.add_lane(made.add_road("9"), "-1", {{0, 503}, {0.01, 503}}, {{0, 500}, {0.01, 500}});
       }},
      {"geometry.tight-bend", [](MadeMap& made) { add_bend(made, 2.0); }},
      {"speed.bend",
       [](MadeMap& made) {
         made.lane(add_bend(made, 20.0)).speed_limits = {{0.0, 25.0}};
       }},
      {"geometry.elevation-spike",
       [](MadeMap& made) {
         made.lane(kB).centre.z_m = {0, 60};
       }},
      {"link.one-sided", [](MadeMap& made) { made.parts.links[2].predecessors.clear(); }},
      {"link.zero-width",
       [](MadeMap& made) {
         made.lane(kA).left.in_map = geometry::Polyline({{0, 3}, {50, 0}});
       }},
      {"link.dead-end",
       [](MadeMap& made) { made.lane(add_bend(made, 30.0)).junction = made.add_junction("4"); }},
      {"link.unreachable",
       [](MadeMap& made) { made.lane(add_bend(made, 30.0)).junction = made.add_junction("4"); }},
      {"link.leads-off-road", [](MadeMap& made) { made.lane(kC).type = LaneType::sidewalk; }},
      {"link.self", [](MadeMap& made) { made.link(kC, kC); }},
      {"link.separate-part", [](MadeMap& made) { add_bend(made, 30.0); }},
      {"neighbour.one-sided", [](MadeMap& made) { made.parts.links[1].left.reset(); }},
      {"neighbour.apart",
       [](MadeMap& made) {
         move(made.lane(kB), {0, -2});
       }},
      {"neighbour.direction", [](MadeMap& made) { turn_round(made.lane(kB)); }},
      {"geometry.overlap",
       [](MadeMap& made) {
         made.add_lane(made.add_road("9"), "-1", {{10, 3.2}, {40, 3.2}}, {{10, 0.2}, {40, 0.2}});
       }},
      {"geometry.far-away",
       [](MadeMap& made) {
         move(made.lane(kB), {5e6, 0});
       }},
      {"speed.missing", [](MadeMap& made) { made.lane(kA).speed_limits.clear(); }},
      {"speed.absurd",
       [](MadeMap& made) {
         made.lane(kA).road.reset();
         made.lane(kA).speed_limits = {{0.0, 500.0}};
       }},
      {"lane.no-participants", [](MadeMap& made) { made.lane(kA).participants = {}; }},
      {"crs.missing", [](MadeMap& made) { made.parts.crs.clear(); }},
      {"crs.broken", [](MadeMap& made) { made.parts.crs = "somewhere in Bavaria"; }},
      {"signal.off-road",
       [](MadeMap& made) {
         made.parts.signals[0].in_map = {50, -90};
       }},
      {"signal.no-lane", [](MadeMap& made) { made.parts.signals[0].lanes.clear(); }},
      {"stop-line.beside",
       [](MadeMap& made) {
         made.parts.stop_lines[0].in_map = {{49, 30, 0}, {49, 27, 0}};
       }},
      {"stop-line.no-lane", [](MadeMap& made) { made.parts.stop_lines[0].lanes.clear(); }},
      {"object.off-road",
       [](MadeMap& made) {
         made.parts.objects[0].in_map = {20, 150};
       }},
      {"regulation.no-lane", [](MadeMap& made) { made.parts.regulations[0].lanes.clear(); }},
  };
}

/// What a map with loose ends is told in any case.
bool is_about_loose_ends(const std::string& rule) {
  return rule == "link.dead-end" || rule == "link.unreachable";
}

TEST(MapRules, FindNothingButLooseEndsInAFaultlessMap) {
  for (const Finding& finding : validate(faultless().build())) {
    EXPECT_TRUE(is_about_loose_ends(finding.rule)) << finding.rule << ": " << finding.message;
    EXPECT_EQ(finding.severity, Severity::info) << finding.rule;
  }
}

TEST(MapRules, FindEverySlip) {
  for (const Slip& slip : slips()) {
    SCOPED_TRACE(slip.rule);
    MadeMap made = faultless();
    const std::size_t before = of_rule(made, slip.rule).size();
    slip.make(made);
    EXPECT_GT(of_rule(made, slip.rule).size(), before);
  }
}

TEST(MapRules, AreAllTried) { tests::expect_all_are_tried(slips(), map_rules()); }

TEST(MapRules, CheckLinksOfLanesThatNoCarDrivesOnToo) {
  MadeMap made = faultless();
  made.lane(kA).type = made.lane(kC).type = LaneType::sidewalk;
  turn_round(made.lane(kC));
  const auto findings = of_rule(made, "link.wrong-end");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_THAT(findings[0].message, ::testing::HasSubstr("other ends of the two meet"));
}

// A bend of 4 m to the right whose outer lane is 3 m wide and whose inner one lies beyond its
// centre: the inner lane runs backwards, which is no fault of what it is linked to or lies beside.
TEST(MapRules, TellOfAFoldOnce) {
  MadeMap made;
  Points rows[3];
  for (int i = 0; i <= 40; ++i) {
    const Eigen::Vector2d outwards(-std::sin(-0.03 * i), std::cos(-0.03 * i));
    for (int row = 0; row < 3; ++row) rows[row].push_back((4.0 - 4.5 * row) * outwards);
  }
  const RoadId road = made.add_road("1");
  const LaneId outer = made.add_lane(road, "-1", rows[0], rows[1]);
  const LaneId inner = made.add_lane(road, "-2", rows[1], rows[2]);
  const Eigen::Vector2d along(std::cos(-1.2), std::sin(-1.2));
  Points left, right;
  for (const double s_m : {0.0, 50.0}) {
    left.push_back(rows[1].back() + s_m * along);
    right.push_back(rows[2].back() + s_m * along);
  }
  const LaneId after = made.add_lane(made.add_road("2"), "-2", left, right);
  made.put_beside(outer, inner);
  made.link(inner, after);
  EXPECT_FALSE(of_rule(made, "geometry.negative-width").empty());
  EXPECT_TRUE(of_rule(made, "link.reversed").empty());
  EXPECT_TRUE(of_rule(made, "neighbour.direction").empty());
}

TEST(MapRules, MeasureAWidthAcrossTheLaneHoweverItsBordersAreDrawn) {
  const auto widths = [](double right_m) {
    MadeMap made;
    made.add_lane(made.add_road("1"), "-1", {{0, 3}, {1, 3}, {2, 3}, {100, 3}},
                  {{0, 0}, {97, right_m}, {98, right_m}, {100, right_m}});
    return of_rule(made, "geometry.absurd-width").size();
  };
  EXPECT_EQ(widths(0), 0u);
  EXPECT_EQ(widths(-60), 1u);
}

TEST(MapRules, TakeNoSlipOfTheLastCentimetreForAReversal) {
  MadeMap made = tests::three_roads_in_a_row();
  Lane& first = made.lane(LaneId{0});
  // The right border jumps out and back along the lane, so that the last chord points backwards.
  first.centre.in_map = geometry::Polyline({{0, 0}, {49.99, 0}, {50.2, 0.0}, {50, 0.001}});
  first.centre.station_m = first.centre.in_map.stations_m();
  first.centre.z_m = {0, 0, 0, 0};
  EXPECT_TRUE(of_rule(made, "link.reversed").empty());
}

TEST(MapRules, MeasureAKinkByBordersWhereTheCentrelineHasACornerOfItsOwn) {
  // The second lane's lines begin at angles of their own, the first one's run eastwards.
  const auto kink = [](double left_rad, double centre_rad, double right_rad) {
    MadeMap made = faultless();
    Lane& second = made.lane(kC);
    const auto turned = [](double y_m, double angle_rad) {
      return geometry::Polyline({{50, y_m}, {90, y_m + 40 * std::tan(angle_rad)}});
    };
    second.left.in_map = turned(3, left_rad);
    second.centre.in_map = turned(1.5, centre_rad);
    second.right.in_map = turned(0, right_rad);
    return of_rule(made, "geometry.kink");
  };
  EXPECT_TRUE(kink(0.0, 0.8, 0.0).empty());
  EXPECT_TRUE(kink(0.3, 0.4, -0.3).empty());
  EXPECT_TRUE(kink(-0.1, 0.6, -0.1).empty());
  const auto found = kink(0.2, 0.8, 0.4);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].severity, Severity::warning);
  EXPECT_THAT(found[0].message, ::testing::HasSubstr("turned by 0.300 rad"));
  EXPECT_THAT(kink(0.8, 0.6, 0.9)[0].message, ::testing::HasSubstr("turned by 0.600 rad"));
}

TEST(MapRules, TakeNoEdgeOfAPartOfAMapForADeadEnd) {
  MadeMap made;
  const LaneId lane = made.add_lane(made.add_road("1"), "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  made.lane(lane).junction = made.add_junction("4");
  EXPECT_EQ(of_rule(made, "link.dead-end").size(), 1u);
  EXPECT_EQ(of_rule(made, "link.unreachable").size(), 1u);
  made.lane(lane).attributes = {{"successors_outside", "7"}};
  EXPECT_TRUE(of_rule(made, "link.dead-end").empty());
  EXPECT_EQ(of_rule(made, "link.unreachable").size(), 1u);
  made.lane(lane).attributes = {{"predecessors_outside", "8"}};
  EXPECT_EQ(of_rule(made, "link.dead-end").size(), 1u);
  EXPECT_TRUE(of_rule(made, "link.unreachable").empty());
}

TEST(MapRules, TakeNoEndWithoutWidthForADeadEnd) {
  const auto ends = [](double from_y_m, double to_y_m, const char* rule) {
    MadeMap made;
    const LaneId lane =
        made.add_lane(made.add_road("1"), "-1", {{0, from_y_m}, {50, to_y_m}}, {{0, 0}, {50, 0}});
    made.lane(lane).junction = made.add_junction("4");
    return of_rule(made, rule).size();
  };
  EXPECT_EQ(ends(3, 0.01, "link.dead-end"), 1u);
  EXPECT_EQ(ends(3, 0, "link.dead-end"), 0u);
  EXPECT_EQ(ends(0.01, 3, "link.unreachable"), 1u);
  EXPECT_EQ(ends(0, 3, "link.unreachable"), 0u);
}

TEST(MapRules, TakeTheTwoDirectionsOfARoadForOnePart) {
  MadeMap made = tests::straight_two_lane_road();
  EXPECT_TRUE(of_rule(made, "link.separate-part").empty());
  // Without a road, as in Lanelet2, they are neighbours or not.
  made.lane(kA).road.reset();
  made.lane(kB).road.reset();
  for (Road& road : made.parts.roads) road.lanes.clear();
  for (LaneLinks& links : made.parts.links) links.left.reset();
  EXPECT_EQ(of_rule(made, "link.separate-part").size(), 1u);
  made.put_opposite(kA, kB);
  EXPECT_TRUE(of_rule(made, "link.separate-part").empty());
}

TEST(MapRules, SayOnceHowManyLanesWithoutARoadHaveNoSpeedLimit) {
  MadeMap made = faultless();
  for (const LaneId lane : {kA, kB, kC}) made.lane(lane).road.reset();
  for (Road& road : made.parts.roads) road.lanes.clear();
  made.lane(kB).speed_limits.clear();
  made.lane(kC).speed_limits.clear();
  const auto found = of_rule(made, "speed.missing");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].element, "lane " + made.lane(kB).name);
  EXPECT_THAT(found[0].message, ::testing::HasSubstr("as 2 of 3 drivable lanes"));
  const double none_mps = std::numeric_limits<double>::infinity();
  for (const LaneId lane : {kB, kC}) made.lane(lane).speed_limits = {{0.0, none_mps}};
  EXPECT_TRUE(of_rule(made, "speed.missing").empty()) << "it is said that there is none";
  EXPECT_TRUE(of_rule(made, "speed.absurd").empty());
}

TEST(MapRules, SayWhereAFormatNamesItsCoordinateSystem) {
  const auto message = [](const std::string& format) {
    MadeMap made = faultless();
    made.parts.crs.clear();
    made.parts.format = format;
    return of_rule(made, "crs.missing").at(0).message;
  };
  EXPECT_THAT(message("OpenDRIVE 1.6"), ::testing::HasSubstr("<geoReference>"));
  EXPECT_THAT(message("CommonRoad 2020a"), ::testing::HasSubstr("<geoTransformation>"));
  EXPECT_THAT(message("Argoverse 2"), ::testing::HasSubstr("--crs"));
  MadeMap made = faultless();
  made.parts.crs.clear();
  made.parts.remarks = {{"import.crs-unknown", false, "file", 0, "its nodes say why"}};
  EXPECT_TRUE(of_rule(made, "crs.missing").empty());
}

TEST(MapRules, NoteSignsFarFromWhatIsLeftOfACutScenario) {
  MadeMap made = faultless();
  made.parts.signals[0].in_map = {50, -90};
  EXPECT_EQ(of_rule(made, "signal.off-road")[0].severity, Severity::warning);
  made.parts.format = "CommonRoad 2020a";
  EXPECT_EQ(of_rule(made, "signal.off-road")[0].severity, Severity::info);
  made.parts.signals[0].lanes.clear();
  EXPECT_EQ(of_rule(made, "signal.off-road")[0].severity, Severity::warning);
}

TEST(MapRules, ExpectNoLaneOfALightForThoseOnFoot) {
  MadeMap made = faultless();
  made.parts.signals[0].lanes.clear();
  EXPECT_EQ(of_rule(made, "signal.no-lane").size(), 1u);
  made.parts.signals[0].type = "1000002";
  EXPECT_TRUE(of_rule(made, "signal.no-lane").empty());
}

TEST(MapRules, FindALaneForAStopLineThatARegulationNames) {
  MadeMap made = faultless();
  made.parts.stop_lines[0].lanes.clear();
  EXPECT_EQ(of_rule(made, "stop-line.no-lane").size(), 1u);
  made.parts.regulations[0].type = "detection_area";
  made.parts.regulations[0].members = {{"ref_line", "6", {}, made.parts.stop_lines[0].in_map, {}}};
  EXPECT_TRUE(of_rule(made, "stop-line.no-lane").empty());
  made.parts.regulations[0].lanes.clear();
  EXPECT_EQ(of_rule(made, "stop-line.no-lane").size(), 1u);
}

TEST(MapRules, LeaveRegulationsOfLanelet2ToTheRulesAboutItsText) {
  MadeMap made = faultless();
  made.parts.regulations[0].lanes.clear();
  made.parts.format = "Lanelet2";
  EXPECT_TRUE(of_rule(made, "regulation.no-lane").empty());
}

TEST(MapRules, TakeTheCornersOfALineDrawnByFewPointsForNoKink) {
  // A bend to the left and one to the right, by a point every 2.4 m, and a corner between them; or
  // between two straight lanes.
  const auto kinks = [](int corners) {
    MadeMap made;
    Points left[2], right[2];
    Eigen::Vector2d at(0, 0);
    double heading_rad = 0.0;
    for (int lane = 0; lane < 2; ++lane) {
      for (int i = 0; i <= corners; ++i) {
        const Eigen::Vector2d across(-std::sin(heading_rad), std::cos(heading_rad));
        left[lane].push_back(at + 1.5 * across);
        right[lane].push_back(at - 1.5 * across);
        if (i == corners) break;
        at += 2.4 * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
        if (i + 1 < corners) heading_rad += lane == 0 ? 0.2 : -0.2;
      }
      heading_rad += 0.15;
    }
    const LaneId from = made.add_lane(made.add_road("1"), "-1", left[0], right[0]);
    const LaneId to = made.add_lane(made.add_road("2"), "-1", left[1], right[1]);
    made.link(from, to);
    return of_rule(made, "geometry.kink").size();
  };
  EXPECT_EQ(kinks(5), 0u);
  EXPECT_EQ(kinks(1), 1u);
}

/// Each place on one of them would have to be looked for in all others.
TEST(MapRules, StopComparingLanesThatAllLieOnEachOther) {
  MadeMap made;
  for (int i = 0; i < 400; ++i) {
    made.add_lane(made.add_road(std::to_string(i)), "-1", {{0, 3}, {2000, 3}}, {{0, 0}, {2000, 0}});
  }
  const auto findings = of_rule(made, "geometry.overlap");
  ASSERT_FALSE(findings.empty());
  EXPECT_THAT(findings.front().message, testing::HasSubstr("were not compared"));
}

TEST(MapRules, TakeNoBridgeForAnOverlap) {
  MadeMap made = faultless();
  const LaneId bridge =
      made.add_lane(made.add_road("9"), "-1", {{10, 3.2}, {40, 3.2}}, {{10, 0.2}, {40, 0.2}});
  EXPECT_EQ(of_rule(made, "geometry.overlap").size(), 2u);
  made.lane(bridge).centre.z_m = {6, 6};
  EXPECT_TRUE(of_rule(made, "geometry.overlap").empty());
}

}  // namespace
}  // namespace roadbed::map::validation
