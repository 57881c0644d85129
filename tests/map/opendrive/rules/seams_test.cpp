// Rules about what meets at a seam: of lane sections, of roads, in junctions; and what a revision
// of the standard asks for.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::validation {
namespace {

std::string linked_lane(int id, const std::string& links, const std::string& width,
                        const std::string& attributes = {}) {
  return fmt::format(
      R"(<lane id="{}" type="driving"{}><link>{}</link><width sOffset="0" {}/></lane>)", id,
      attributes, links, width);
}

const std::string kWide = R"(a="3.5" b="0" c="0" d="0")";
const std::string kNarrows = R"(a="3.5" b="-0.035" c="0" d="0")";  // to nothing in 100 m
const std::string kWidens = R"(a="0" b="0.035" c="0" d="0")";

/// Two roads of 100 m, one behind the other, with the lanes 1 and −1 each; `mirrored` turns the
/// second one round, so that both end where they meet.
struct TwoRoads {
  std::string left = linked_lane(1, R"(<successor id="1"/>)", kWide);
  std::string right = linked_lane(-1, R"(<successor id="-1"/>)", kWide);
  std::string next_left = linked_lane(1, R"(<predecessor id="1"/>)", kWide);
  std::string next_right = linked_lane(-1, R"(<predecessor id="-1"/>)", kWide);
  std::string lateral;

  std::string text(const char* revision = "8") const {
    tests::MadeRoad one, two;
    one.link = R"(<successor elementType="road" elementId="B" contactPoint="start"/>)";
    one.lateral = lateral;
    one.lanes = tests::made_section(0, left, right);
    two.id = "B";
    two.x_m = 100;
    two.link = R"(<predecessor elementType="road" elementId="A" contactPoint="end"/>)";
    two.lanes = tests::made_section(0, next_left, next_right);
    std::string document = tests::made_document(tests::made_road(one) + tests::made_road(two));
    const std::size_t at = document.find("revMinor=\"") + 10;
    return document.replace(at, document.find('"', at) - at, revision);
  }
};

std::vector<std::string> elements_of(const std::string& text, const std::string& rule) {
  std::vector<std::string> elements;
  for (const Finding& finding : tests::source_findings(text, "made.xodr", rule)) {
    elements.push_back(finding.element);
  }
  return elements;
}

using Elements = std::vector<std::string>;

TEST(OpenDriveSeams, ALaneWithoutWidthIsNamedByTheEndAlongItsRoad) {
  TwoRoads roads;
  EXPECT_TRUE(elements_of(roads.text(), "link.zero-width-start").empty());
  EXPECT_TRUE(elements_of(roads.text(), "link.zero-width-end").empty());
  // Lane 1 is driven against s: its end along the road is where its traffic comes from.
  roads.left = linked_lane(1, R"(<successor id="1"/>)", kNarrows);
  EXPECT_EQ(elements_of(roads.text(), "link.zero-width-end"), Elements{"lane A/0/1"});
  EXPECT_TRUE(elements_of(roads.text(), "link.zero-width-start").empty());
  roads.next_right = linked_lane(-1, R"(<predecessor id="-1"/>)", kWidens);
  EXPECT_EQ(elements_of(roads.text(), "link.zero-width-start"), Elements{"lane B/0/-1"});
  for (const Finding& finding : validate_bytes(roads.text(), "made.xodr").findings) {
    if (finding.element != "lane A/0/1" ||
        finding.asam_rule.find("zero_width") == std::string::npos)
      continue;
    EXPECT_EQ(finding.asam_rule, "asam.net:xodr:1.7.0:road.lane.link.zero_width_at_end");
  }
}

TEST(OpenDriveSeams, ANewLaneLinkedToTheOneBesideIsFoundFromRoadToRoad) {
  TwoRoads roads;
  EXPECT_TRUE(elements_of(roads.text(), "link.appearing-lane").empty());
  roads.next_right = linked_lane(-1, R"(<predecessor id="-1"/>)", kWidens);
  EXPECT_EQ(elements_of(roads.text(), "link.appearing-lane"), Elements{"lane B/0/-1"});
}

TEST(OpenDriveSeams, AChangeOfLevelIsAWarningOnALeaningRoadAndElseANote) {
  TwoRoads roads;
  EXPECT_TRUE(elements_of(roads.text(), "lane.level-change").empty());
  roads.next_left = linked_lane(1, R"(<predecessor id="1"/>)", kWide, R"( level="true")");
  auto findings = tests::source_findings(roads.text(), "made.xodr", "lane.level-change");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::info);
  roads.lateral = R"(<superelevation s="0" a="0.05" b="0" c="0" d="0"/>)";
  findings = tests::source_findings(roads.text(), "made.xodr", "lane.level-change");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
}

TEST(OpenDriveSeams, OlderRevisionsDidNotAskForLevelLanesFurtherOut) {
  TwoRoads roads;
  roads.left = linked_lane(1, R"(<successor id="1"/>)", kWide, R"( level="true")") +
               linked_lane(2, "", kWide);
  const auto level = [&](const char* revision) {
    for (const Finding& finding : validate_bytes(roads.text(revision), "made.xodr").findings) {
      if (finding.rule == "lane.level") return finding;
    }
    return Finding{};
  };
  EXPECT_EQ(level("7").asam_rule, "asam.net:xodr:1.7.0:road.lane.level_true_one_side");
  EXPECT_EQ(level("7").severity, Severity::error);
  EXPECT_EQ(level("6").rule, "lane.level");
  EXPECT_EQ(level("6").asam_rule, "");
  EXPECT_EQ(level("6").severity, Severity::info);
}

TEST(OpenDriveSeams, ALaneOffsetMayStepWhereTheLanesMakeUpForIt) {
  const auto road_with = [](double step_m) {
    tests::MadeRoad road;
    road.lanes = fmt::format(R"(<laneOffset s="0" a="0" b="0" c="0" d="0"/>)"
                             R"(<laneOffset s="50" a="{}" b="0" c="0" d="0"/>)",
                             step_m) +
                 tests::made_section(0, "", linked_lane(-1, R"(<successor id="-2"/>)", kWide)) +
                 tests::made_section(50, "",
                                     linked_lane(-1, "", kWide) +
                                         linked_lane(-2, R"(<predecessor id="-1"/>)", kWide));
    return tests::made_document(tests::made_road(road));
  };
  // A lane begins on the left, and the offset moves over by its width.
  EXPECT_TRUE(elements_of(road_with(3.5), "lane-offset.step").empty());
  EXPECT_EQ(elements_of(road_with(3.0), "lane-offset.step"), Elements{"road A"});
}

TEST(OpenDriveSeams, TwoRecordsOfOneStationAreOneTooMany) {
  const auto road_with = [](const char* second) {
    tests::MadeRoad road;
    road.lanes = std::string(R"(<laneOffset s="0" a="1" b="0" c="0" d="0"/>)") + second +
                 tests::made_section(0, "", linked_lane(-1, "", kWide));
    return tests::made_document(tests::made_road(road));
  };
  const std::string again = road_with(R"(<laneOffset s="0" a="1" b="0" c="0" d="0"/>)");
  EXPECT_EQ(elements_of(again, "profile.redundant"), Elements{"road A"});
  EXPECT_TRUE(elements_of(again, "profile.same-station").empty());
  const std::string other = road_with(R"(<laneOffset s="0" a="2" b="0" c="0" d="0"/>)");
  EXPECT_EQ(elements_of(other, "profile.same-station"), Elements{"road A"});
  EXPECT_TRUE(elements_of(other, "lane-offset.step").empty());
}

TEST(OpenDriveSeams, ARecordBeyondTheRoadMakesNoStep) {
  tests::MadeRoad road;
  road.lanes =
      R"(<laneOffset s="0" a="0" b="0" c="0" d="0"/><laneOffset s="120" a="4" b="0" c="0" d="0"/>)" +
      tests::made_section(0, "", linked_lane(-1, "", kWide));
  const std::string text = tests::made_document(tests::made_road(road));
  EXPECT_EQ(elements_of(text, "profile.beyond-road"), Elements{"road A"});
  EXPECT_TRUE(elements_of(text, "lane-offset.step").empty());
}

TEST(OpenDriveSeams, ADirectionThatNoLaneHasIsFound) {
  TwoRoads roads;
  roads.left = linked_lane(1, R"(<successor id="1"/>)", kWide, R"( direction="sideways")");
  EXPECT_EQ(elements_of(roads.text(), "schema.unknown-value").size(), 1u);
  roads.left = linked_lane(1, R"(<successor id="1"/>)", kWide, R"( direction="both")");
  EXPECT_TRUE(elements_of(roads.text(), "schema.unknown-value").empty());
}

/// A road, a connecting road behind it, and what the connection between them links.
std::string junction_text(const std::string& lane_link, const std::string& direction = "standard",
                          const char* rule = "RHT") {
  tests::MadeRoad incoming, via;
  incoming.attributes = via.attributes = fmt::format(R"(rule="{}")", rule);
  incoming.link = R"(<successor elementType="junction" elementId="7"/>)";
  const std::string attributes = fmt::format(R"( direction="{}")", direction);
  incoming.lanes = tests::made_section(0, linked_lane(1, "", kWide, attributes),
                                       linked_lane(-1, "", kWide, attributes));
  via.id = "V";
  via.x_m = 100;
  via.link = R"(<predecessor elementType="road" elementId="A" contactPoint="end"/>)";
  via.lanes = incoming.lanes;
  std::string made = tests::made_road(via);
  const std::size_t at = made.find("junction=\"-1\"");
  EXPECT_NE(at, std::string::npos);
  made.replace(at, 13, "junction=\"7\"");
  return tests::made_document(
      tests::made_road(incoming) + made +
      fmt::format(R"(<junction id="7" name="j"><connection id="0" incomingRoad="A" )"
                  R"(connectingRoad="V" contactPoint="start">{}</connection></junction>)",
                  lane_link));
}

TEST(OpenDriveSeams, ALaneLinkLeadsIntoTheJunctionOnly) {
  const auto count = [](const std::string& text) {
    return elements_of(text, "junction.outgoing-lane-link").size();
  };
  const std::string in = R"(<laneLink from="-1" to="-1"/>)", out = R"(<laneLink from="1" to="1"/>)";
  EXPECT_EQ(count(junction_text(in)), 0u);
  EXPECT_EQ(count(junction_text(out)), 1u);
  // Traffic on the left, or lanes that run the other way, or both ways.
  EXPECT_EQ(count(junction_text(in, "standard", "LHT")), 1u);
  EXPECT_EQ(count(junction_text(out, "standard", "LHT")), 0u);
  EXPECT_EQ(count(junction_text(in, "reversed")), 1u);
  EXPECT_EQ(count(junction_text(out, "reversed")), 0u);
  EXPECT_EQ(count(junction_text(in + out, "both")), 0u);
}

TEST(OpenDriveSeams, AConnectingRoadLinkedToAThirdRoadIsFound) {
  std::string text = junction_text("");
  EXPECT_TRUE(elements_of(text, "junction.contact-start").empty());
  const std::string to = R"(elementId="A" contactPoint="end")";
  text.replace(text.find(to), to.size(), R"(elementId="C" contactPoint="end")");
  EXPECT_EQ(elements_of(text, "junction.contact-start"), Elements{"junction 7"});
}

TEST(OpenDriveSeams, AnotherRootElementIsAFindingAndNoMap) {
  std::string text = TwoRoads().text();
  for (std::size_t at = 0; (at = text.find("OpenDRIVE", at)) != std::string::npos;) {
    text.replace(at, 9, "OpenDrive");
  }
  const Validation validation = validate_bytes(text, "made.xodr");
  EXPECT_FALSE(validation.road_map);
  EXPECT_FALSE(validation.refusal.empty());
  ASSERT_EQ(validation.findings.size(), 1u);
  EXPECT_EQ(validation.findings[0].rule, "source.root-element");
  EXPECT_EQ(validation.findings[0].asam_rule, "asam.net:xodr:1.0.0:xml.root_tag_is_opendrive");
  EXPECT_GT(validation.findings[0].line, 0);
}

}  // namespace
}  // namespace roadbed::map::validation
