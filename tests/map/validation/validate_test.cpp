#include "roadbed/map/validation/validate.h"
#include "roadbed/map/validate_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/load_map.h"
#include "roadbed/map/validation/rule.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::validation {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using ::testing::HasSubstr;

std::vector<Finding> of_rule(const RoadMap& road_map, const std::string& rule,
                             const ValidateOptions& options = {}) {
  auto findings = validate(road_map, options);
  std::erase_if(findings, [&](const Finding& finding) { return finding.rule != rule; });
  return findings;
}

/// Two linked lanes eastwards, 4 m wide; the second one is moved and turned about its start.
tests::MadeMap two_lanes(double gap_m, double turn_rad) {
  tests::MadeMap made;
  const LaneId a = made.add_lane(made.add_road("1"), "-1", {{0, 2}, {50, 2}}, {{0, -2}, {50, -2}});
  const geometry::Pose2 place{50.0, gap_m, turn_rad};
  const Points left = {place * Eigen::Vector2d(0, 2), place * Eigen::Vector2d(50, 2)};
  const Points right = {place * Eigen::Vector2d(0, -2), place * Eigen::Vector2d(50, -2)};
  const LaneId b = made.add_lane(made.add_road("2"), "-1", left, right);
  made.link(a, b);
  return made;
}

TEST(Validate, FindsNothingWrongWithAFaultlessRoad) {
  for (const Finding& finding : validate(tests::three_roads_in_a_row().build())) {
    EXPECT_EQ(finding.severity, Severity::info) << finding.message;
    EXPECT_THAT(finding.rule, ::testing::AnyOf("link.dead-end", "link.unreachable", "crs.missing"));
  }
}

TEST(Validate, LooksAtLinesAsFineAsItIsAsked) {
  const auto points = [](double max_error_m) {
    const Validation judged =
        validate_bytes(tests::curved_road_xml(), "curved.xodr", {.max_error_m = max_error_m});
    return judged.road_map.value().lanes()[0].centre.in_map.points().size();
  };
  EXPECT_GT(points(1e-3), 3 * points(0.1));
}

TEST(Validate, ReportsGapsAboveTheLimitOnly) {
  EXPECT_TRUE(of_rule(two_lanes(0.009, 0.0).build(), "geometry.gap").empty());
  EXPECT_TRUE(of_rule(two_lanes(0.2, 0.0).build(), "geometry.gap", {.max_gap_m = 0.3}).empty());
  const auto findings = of_rule(two_lanes(0.2, 0.0).build(), "geometry.gap");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[0].element, "lane 1/0/-1");
  EXPECT_EQ(findings[0].asam_rule,
            "asam.net:xodr:1.7.0:lane_smoothness.contact_point_no_horizontal_gaps");
  EXPECT_THAT(findings[0].message, HasSubstr("lane 2/0/-1, left border by 0.200 m"));
  EXPECT_NEAR((findings[0].in_map.value() - Eigen::Vector2d(50, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(of_rule(two_lanes(0.6, 0.0).build(), "geometry.gap")[0].severity, Severity::error);
}

TEST(Validate, TakesALaneThatSplitsIntoTwoForWhole) {
  tests::MadeMap made;
  const LaneId whole =
      made.add_lane(made.add_road("1"), "-1", {{0, 3}, {50, 3}}, {{0, -3}, {50, -3}});
  const RoadId road = made.add_road("2");
  const LaneId left = made.add_lane(road, "-1", {{50, 3}, {90, 3}}, {{50, 0}, {90, 0}});
  const LaneId right = made.add_lane(road, "-2", {{50, 0}, {90, 0}}, {{50, -3}, {90, -3}});
  made.link(whole, left);
  EXPECT_EQ(of_rule(made.build(), "geometry.gap").size(), 1u);  // half of it leads nowhere
  made.link(whole, right);
  made.put_beside(left, right);
  EXPECT_TRUE(of_rule(made.build(), "geometry.gap").empty());
}

TEST(Validate, ReportsKinksAboveTheLimitWithTheirSign) {
  EXPECT_TRUE(of_rule(two_lanes(0.0, 0.04).build(), "geometry.kink").empty());
  const auto findings = of_rule(two_lanes(0.0, -0.1).build(), "geometry.kink");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_THAT(findings[0].message, HasSubstr("-0.100 rad"));
  EXPECT_EQ(of_rule(two_lanes(0.0, 0.6).build(), "geometry.kink")[0].severity, Severity::error);
}

TEST(Validate, FindsNoKinkBetweenCoarseChordsOfOneArc) {
  // Chords of 0.1 rad meet at 0.1 rad, but the arcs that they stand for meet at none.
  const auto arc = [](double radius_m, int from, int to) {
    Points points;
    for (int i = from; i <= to; ++i) {
      points.emplace_back(radius_m * std::cos(0.1 * i), radius_m * std::sin(0.1 * i));
    }
    return points;
  };
  tests::MadeMap made;
  const LaneId a = made.add_lane(made.add_road("1"), "-1", arc(8, 0, 7), arc(12, 0, 7));
  const LaneId b = made.add_lane(made.add_road("2"), "-1", arc(8, 7, 15), arc(12, 7, 15));
  made.link(a, b);
  EXPECT_TRUE(of_rule(made.build(), "geometry.kink").empty());
}

TEST(Validate, ReportsSwappedBordersWhereTheyAreFarthestApart) {
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", {{0, 2}, {50, -1}, {100, 2}},
                {{0, -2}, {50, 1}, {100, -2}});
  const auto findings = of_rule(made.build(), "geometry.negative-width");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_THAT(findings[0].message, HasSubstr("station 50.00 m, width -2.000 m"));
}

TEST(Validate, ReportsDrivableLanesWithoutAnyWidth) {
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", {{0, 0}, {50, 0}}, {{0, 0}, {50, 0}});
  EXPECT_EQ(of_rule(made.build(), "geometry.zero-width").size(), 1u);
  made.lane(LaneId{0}).type = LaneType::shoulder;
  EXPECT_TRUE(of_rule(made.build(), "geometry.zero-width").empty());
}

/// A lane to the right of a left bend of 10 m radius about the origin, or, if `reach_m` is more
/// than 10, one whose left border is thrown beyond the bend's centre.
tests::MadeMap bend(double reach_m) {
  Points left, right;
  for (int i = 0; i <= 60; ++i) {
    const Eigen::Vector2d outwards(std::cos(0.025 * i), std::sin(0.025 * i));
    left.push_back((10.0 - reach_m) * outwards);
    right.push_back((10.0 + reach_m) * outwards);
  }
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", left, right);
  return made;
}

TEST(Validate, ReportsBordersThatFoldInATightBend) {
  EXPECT_TRUE(of_rule(bend(9.0).build(), "geometry.fold").empty());
  const auto findings = of_rule(bend(11.0).build(), "geometry.fold");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_THAT(findings[0].message, HasSubstr("over 1.500 m"));  // 1 m · 1.5 rad beyond the centre
}

TEST(Validate, ReportsALaneThatCrossesItself) {
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", {{0, 1}, {41, 1}, {41, 31}, {19, 31}, {19, -30}},
                {{0, -1}, {43, -1}, {43, 33}, {17, 33}, {17, -30}});
  const auto findings = of_rule(made.build(), "geometry.self-intersection");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].element, "lane 1/0/-1");
}

TEST(Validate, ReportsLinksThatOnlyOneSideKnows) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.parts.links[1].predecessors.clear();
  const auto findings = of_rule(made.build(), "link.one-sided");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_EQ(findings[0].element, "lane 1/0/-1");
  EXPECT_THAT(findings[0].message, HasSubstr("lane 2/0/-1 as successor"));
}

TEST(Validate, ReportsLinksAtEndsWithoutWidth) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId ends = made.add_lane(road, "-1", {{0, 3}, {50, 0}}, {{0, 0}, {50, 0}});
  const LaneId next = made.add_lane(road, "-2", {{50, 0}, {90, 3}}, {{50, 0}, {90, 0}});
  EXPECT_TRUE(of_rule(made.build(), "link.zero-width").empty());
  made.link(ends, next);
  const auto findings = of_rule(made.build(), "link.zero-width");
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].asam_rule, "asam.net:xodr:1.7.0:road.lane.link.zero_width_at_end");
  EXPECT_EQ(findings[1].asam_rule, "asam.net:xodr:1.7.0:road.lane.link.zero_width_at_start");
}

TEST(Validate, WarnsOfDeadEndsInJunctionsAndNotesOthers) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.parts.links[1].successors.clear();
  made.parts.links[2].predecessors.clear();
  const auto findings = of_rule(made.build(), "link.dead-end");
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[1].severity, Severity::info);
}

TEST(Validate, NotesPartsThatNothingLeadsTo) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.add_lane(made.add_road("9"), "-1", {{0, 103}, {50, 103}}, {{0, 100}, {50, 100}});
  const auto findings = of_rule(made.build(), "link.separate-part");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].element, "lane 9/0/-1");
}

TEST(Validate, NotesMissingSpeedsOncePerRoadOrOncePerMap) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane(LaneId{1}).speed_limits.clear();
  auto findings = of_rule(made.build(), "speed.missing");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].element, "road 2");
  made.lane(LaneId{0}).speed_limits.clear();
  made.lane(LaneId{2}).speed_limits.clear();
  findings = of_rule(made.build(), "speed.missing");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].element, "map");
}

TEST(Validate, PassesOnWhatTheReaderOfTheFileHasSeen) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.remarks = {{"import.link", true, "road 1", 17, "leads to road 9, which is not there"},
                        {"import.unused-element", false, "<userData>", 4, "not used"}};
  const auto faults = of_rule(made.build(), "import.link");
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, Severity::warning);
  EXPECT_EQ(faults[0].line, 17);
  EXPECT_EQ(of_rule(made.build(), "import.unused-element")[0].severity, Severity::info);
}

TEST(Validate, ListsEveryRuleOnceInOrderWithItsMeaning) {
  const auto catalogue = rule_catalogue();
  EXPECT_GE(catalogue.size(), 50u);
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    EXPECT_TRUE(i == 0 || catalogue[i - 1].id < catalogue[i].id) << catalogue[i].id;
    EXPECT_FALSE(catalogue[i].meaning.empty()) << catalogue[i].id;
    const auto asam = catalogue[i].asam_rule;
    EXPECT_TRUE(asam.empty() || asam.starts_with("asam.net:xodr:1.")) << asam;
  }
}

TEST(Validate, SortsByRule) {
  const auto findings = validate(tests::straight_two_lane_road().build());
  EXPECT_TRUE(std::is_sorted(findings.begin(), findings.end(),
                             [](const Finding& a, const Finding& b) { return a.rule < b.rule; }));
}

TEST(Validate, FindsNoErrorAndNoWarningInTownsThatAreDrivenEveryDay) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  for (const std::string town : {"Town01", "Town04", "Town10HD"}) {
    const auto file = folder / "opendrive/BerkeleyLearnVerify+Scenic" / (town + ".xodr");
    for (const Finding& finding : validate_file(file).findings) {
      EXPECT_EQ(finding.severity, Severity::info)
          << town << ": " << finding.element << ": " << finding.message;
    }
  }
}

TEST(Validate, TellsAsamsGapsFromItsSmoothFiles) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto count = [&](const std::string& file) {
    const auto road_map =
        load_map(folder / "opendrive/asam-ev+qc-opendrive/smoothness_example" / (file + ".xodr"));
    return of_rule(road_map, "geometry.gap").size();
  };
  EXPECT_EQ(count("simple_valid"), 0u);
  EXPECT_EQ(count("junction_valid_conn_smoothness"), 0u);
  EXPECT_EQ(count("multiple_successor_valid"), 0u);
  EXPECT_GT(count("junction_invalid_conn_smoothness"), 0u);
  EXPECT_GT(count("multiple_successor_invalid"), 0u);
  EXPECT_GT(count("many_invalid"), 0u);
}

}  // namespace
}  // namespace roadbed::map::validation
