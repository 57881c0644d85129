// Hostile files: a clear refusal or findings, with memory bounded by the file's size.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/bounded_reading.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using tests::made_document;
using tests::made_lane;
using tests::made_map;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

std::string outcome_of(const std::string& bytes) {
  try {
    return fmt::format("read {} lanes", parse_map(bytes, "made.xodr").lanes().size());
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string sections(int count, const std::string& inside) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += fmt::format(R"(<laneSection s="{}">{}</laneSection>)", 100.0 * i / count, inside);
  }
  return all;
}

TEST(OpenDriveLimits, AMillionEmptyLaneSectionsAreRead) {
  MadeRoad road;
  road.lanes = sections(1'000'000, "");
  tests::expect_read_in_bounds(made_document(made_road(road)), "read 0 lanes");
}

TEST(OpenDriveLimits, AMillionLaneSectionsWithLanesAreRefused) {
  MadeRoad road;
  road.lanes = sections(
      1'000'000,
      R"(<right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right>)");
  tests::expect_read_in_bounds(made_document(made_road(road)),
                               "more lanes than a map of this size can hold");
}

TEST(OpenDriveLimits, SingleSidedSectionsByTheHundredThousandTakeNoQuadraticTime) {
  MadeRoad road;
  const std::string left = R"(<left><lane id="1" type="driving"><link><predecessor id="1"/>
    <successor id="1"/></link><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></left>)";
  std::string all = made_section(0, made_lane(1), made_lane(-1));
  for (int i = 1; i < 20'000; ++i) {
    all +=
        fmt::format(R"(<laneSection s="{}" singleSide="true">{}</laneSection>)", 0.005 * i, left);
  }
  road.lanes = all;
  tests::expect_read_in_bounds(made_document(made_road(road)), "read 20001 lanes");
}

// Of `many` things that each would have `many` others, those that have none are said, one by one.
void expect_rest_is_said(const RoadMap& road_map, std::size_t pairs, std::size_t many,
                         const char* words) {
  EXPECT_GT(pairs, 100'000u);
  EXPECT_LT(pairs, 1'000'000u);
  EXPECT_EQ(road_map.import_diagnostics().size(), many - pairs / many);
  EXPECT_THAT(road_map.import_diagnostics().back().message, HasSubstr(words));
}

TEST(OpenDriveLimits, SignalsOfMoreLanesThanAMapCanHoldAreSaid) {
  constexpr int kMany = 2'000;
  std::string lanes;
  for (int i = 1; i <= kMany; ++i) lanes += made_lane(-i);
  MadeRoad road;
  road.lanes = made_section(0, "", lanes);
  road.rest = "<signals>";
  for (int i = 0; i < kMany; ++i) {
    road.rest += fmt::format(R"(<signal id="{}" s="5" t="0" orientation="+" type="274"/>)", i);
  }
  road.rest += "</signals>";
  const RoadMap road_map = made_map(made_road(road));
  std::size_t pairs = 0;
  for (const Signal& signal : road_map.signals()) pairs += signal.lanes.size();
  expect_rest_is_said(road_map, pairs, kMany,
                      "speak to more lanes than a map of this size can hold");
}

TEST(OpenDriveLimits, StopLinesOfMoreLightsThanAMapCanHoldAreSaid) {
  constexpr int kMany = 2'000;
  std::string lines, lights;
  for (int i = 0; i < kMany; ++i) {
    lines += fmt::format(
        R"(<object id="{}" name="StopLine" s="5" t="-1" zOffset="0" length="0.3" width="3"/>)", i);
    lights += fmt::format(
        R"(<signal id="{}" s="5" t="0" orientation="+" type="1000001" dynamic="yes"/>)", i);
  }
  MadeRoad road;
  road.lanes = made_section(0, "", made_lane(-1));
  road.rest = "<objects>" + lines + "</objects><signals>" + lights + "</signals>";
  const RoadMap road_map = made_map(made_road(road));
  std::size_t pairs = 0;
  for (const StopLine& line : road_map.stop_lines()) pairs += line.signals.size();
  expect_rest_is_said(road_map, pairs, kMany, "it is left out");
}

TEST(OpenDriveLimits, EmptyElementsAndLinesAreBounded) {
  tests::expect_read_in_bounds("<OpenDRIVE>" + tests::repeated(5'000'000, "<a/>") + "</OpenDRIVE>",
                               "next to nothing but empty elements");
  tests::expect_read_in_bounds("<OpenDRIVE>" + std::string(30'000'000, '\n') + "</OpenDRIVE>",
                               "no road with a geometry");
  tests::expect_read_in_bounds(tests::repeated(200'000, "<a>"), "not well-formed XML");
}

TEST(OpenDriveLimits, ARoadOfEndlessCurvesIsRefused) {
  MadeRoad road;
  road.length_m = 1e6;
  std::string pieces;
  for (int i = 0; i < 10'000; ++i) {
    pieces += fmt::format(
        R"(<geometry s="{}" x="0" y="0" hdg="0" length="100"><arc curvature="0.9"/></geometry>)",
        100 * i);
  }
  road.plan_view = pieces;
  tests::expect_read_in_bounds(made_document(made_road(road)),
                               "more points than a map of this size can hold");
}

// A lane that lies over itself is cut where it does so, which takes time by its points.
TEST(OpenDriveLimits, ARampOfManyStoreysIsReadAndEndlessWindingRefused) {
  MadeRoad road;
  const auto turns = [&](int count, double radius_m, int roads) {
    road.length_m = 2.0 * std::numbers::pi * radius_m * count;
    road.plan_view = fmt::format(
        R"(<geometry s="0" x="0" y="0" hdg="0" length="{}"><arc curvature="{}"/></geometry>)",
        road.length_m, 1.0 / radius_m);
    std::string all;
    for (int i = 0; i < roads; ++i) {
      road.id = std::to_string(i);
      all += made_road(road);
    }
    return made_document(all);
  };
  tests::expect_read_in_bounds(turns(6, 20.0, 1), "read 2 lanes");
  tests::expect_read_in_bounds(turns(15, 20.0, 10), "fold over themselves");
}

TEST(OpenDriveLimits, EntityBombsStayWords) {
  std::string bomb = "<!DOCTYPE x [<!ENTITY a0 \"aaaaaaaaaa\">";
  for (int i = 1; i < 30; ++i) bomb += fmt::format("<!ENTITY a{} \"&a{};&a{};\">", i, i - 1, i - 1);
  bomb += "<!ENTITY e SYSTEM \"file:///etc/passwd\">]>";
  tests::expect_read_in_bounds(
      bomb + made_document("<road id=\"&a29;&e;\" length=\"0\"/>" + made_road({})), "read 2 lanes");
}

TEST(OpenDriveLimits, NumbersBeyondAnyRoadAreRefusedOrSaid) {
  const auto with = [](auto change) {
    MadeRoad road;
    change(road);
    return outcome_of(made_document(made_road(road)));
  };
  for (const char* value : {"1e300", "nan", "inf", "-1e308", "1e"}) {
    const std::string cubic = fmt::format(R"( s="0" a="{}" b="0" c="0" d="0"/>)", value);
    EXPECT_THAT(with([&](MadeRoad& road) { road.elevation = "<elevation" + cubic; }),
                HasSubstr("made.xodr:"))
        << value;
    EXPECT_THAT(with([&](MadeRoad& road) { road.lateral = "<superelevation" + cubic; }),
                HasSubstr("made.xodr:"))
        << value;
    EXPECT_THAT(with([&](MadeRoad& road) { road.lateral = R"(<shape t="0")" + cubic; }),
                HasSubstr("made.xodr:"))
        << value;
    EXPECT_THAT(with([&](MadeRoad& road) {
                  road.lanes = made_section(
                      0, "",
                      fmt::format(R"(<lane id="-1" type="driving"><width sOffset="{}" a="3"
                         b="0" c="0" d="0"/></lane>)",
                                  value));
                }),
                HasSubstr("made.xodr:"))
        << value;
  }
}

TEST(OpenDriveLimits, OfAnAttributeThatIsRepeatedTheFirstCounts) {
  MadeRoad road;
  road.lateral = R"(<crossfall b="0" s="0" a=".1" b="-inf" c="0" d="0"/>)";
  EXPECT_THAT(outcome_of(made_document(made_road(road))), HasSubstr("read 2 lanes"));
  road.lateral = R"(<crossfall b="-inf" s="0" a=".1" b="0" c="0" d="0"/>)";
  EXPECT_THAT(outcome_of(made_document(made_road(road))), HasSubstr("read 2 lanes"));
}

TEST(OpenDriveLimits, StationsBeyondAnyRoadAreRefused) {
  MadeRoad road;
  road.lanes = made_section(0, made_lane(1), made_lane(-1)) +
               made_section(1e300, made_lane(1), made_lane(-1));
  EXPECT_THAT(outcome_of(made_document(made_road(road))),
              HasSubstr("s 1e+300 m, needs at most 1e6 m"));
  road = {};
  road.plan_view = R"(<geometry s="1e300" x="9" y="1" hdg="0.5" length="100">
    <poly3 a="0" b="0" c="1" d="0"/></geometry>)";
  EXPECT_THAT(outcome_of(made_document(made_road(road))),
              HasSubstr("s 1e+300 m, needs at most 1e6 m"));
}

TEST(OpenDriveLimits, TinyAndZeroLengthsAreFindings) {
  MadeRoad road;
  road.lanes =
      made_section(0, made_lane(1), made_lane(-1)) + made_section(100, made_lane(1), made_lane(-1));
  road.plan_view = R"(<geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry>
    <geometry s="100" x="100" y="0" hdg="0" length="0"><line/></geometry>)";
  const RoadMap road_map = tests::made_map(
      made_road(road) + R"(<road id="Z" length="0" junction="-1"><planView/><lanes/></road>)");
  EXPECT_EQ(road_map.lanes().size(), 2u);
  EXPECT_EQ(tests::remarks_of(road_map, "import.empty-section").size(), 2u);
  EXPECT_EQ(tests::remarks_of(road_map, "import.zero-length").size(), 1u);
  EXPECT_EQ(tests::remarks_of(road_map, "import.no-geometry").size(), 1u);
}

}  // namespace
}  // namespace roadbed::map
