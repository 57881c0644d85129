// Hostile files: a clear refusal or findings, with memory bounded by the file's size.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using tests::made_document;
using tests::made_lane;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

constexpr bool kMeasuresMemory =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    false;
#else
    true;
#endif

struct Reading {
  std::string outcome;  // "read" or the refusal
  long peak_bytes = 0;  // of a process that only reads it
};

std::string outcome_of(const std::string& bytes) {
  try {
    return fmt::format("read {} lanes", parse_map(bytes, "made.xodr").lanes().size());
  } catch (const InputError& error) {
    return error.what();
  }
}

Reading read_in_a_child(const std::string& bytes) {
  int pipe_ends[2];
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("pipe failed");
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string outcome = outcome_of(bytes);
    const auto written =
        ::write(pipe_ends[1], outcome.data(), std::min<std::size_t>(outcome.size(), 4000));
    ::_exit(written > 0 ? 0 : 1);
  }
  ::close(pipe_ends[1]);
  Reading reading;
  char buffer[4096];
  for (ssize_t got = 0; (got = ::read(pipe_ends[0], buffer, sizeof buffer)) > 0;) {
    reading.outcome.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(pipe_ends[0]);
  int state = 0;
  rusage usage{};
  ::wait4(child, &state, 0, &usage);
  if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) reading.outcome = "crashed";
  reading.peak_bytes = usage.ru_maxrss * 1024;
  return reading;
}

void expect_bounded(const std::string& bytes, const std::string& outcome) {
  const Reading reading = read_in_a_child(bytes);
  EXPECT_THAT(reading.outcome, HasSubstr(outcome));
  if (!kMeasuresMemory) return;
  EXPECT_LT(reading.peak_bytes, 256'000'000 + 8 * static_cast<long>(bytes.size()))
      << "of " << bytes.size() << " bytes";
}

std::string repeated(int times, const std::string& text) {
  std::string all;
  all.reserve(static_cast<std::size_t>(times) * text.size());
  for (int i = 0; i < times; ++i) all += text;
  return all;
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
  expect_bounded(made_document(made_road(road)), "read 0 lanes");
}

TEST(OpenDriveLimits, AMillionLaneSectionsWithLanesAreRefused) {
  MadeRoad road;
  road.lanes = sections(
      1'000'000,
      R"(<right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right>)");
  expect_bounded(made_document(made_road(road)), "more lanes than a map of this size can hold");
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
  expect_bounded(made_document(made_road(road)), "read 20001 lanes");
}

TEST(OpenDriveLimits, EmptyElementsAndLinesAreBounded) {
  expect_bounded("<OpenDRIVE>" + repeated(5'000'000, "<a/>") + "</OpenDRIVE>",
                 "next to nothing but empty elements");
  expect_bounded("<OpenDRIVE>" + std::string(30'000'000, '\n') + "</OpenDRIVE>",
                 "no road with a geometry");
  expect_bounded(repeated(200'000, "<a>"), "not well-formed XML");
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
  expect_bounded(made_document(made_road(road)), "more points than a map of this size can hold");
}

TEST(OpenDriveLimits, EntityBombsStayWords) {
  std::string bomb = "<!DOCTYPE x [<!ENTITY a0 \"aaaaaaaaaa\">";
  for (int i = 1; i < 30; ++i) bomb += fmt::format("<!ENTITY a{} \"&a{};&a{};\">", i, i - 1, i - 1);
  bomb += "<!ENTITY e SYSTEM \"file:///etc/passwd\">]>";
  expect_bounded(bomb + made_document("<road id=\"&a29;&e;\" length=\"0\"/>" + made_road({})),
                 "read 2 lanes");
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
