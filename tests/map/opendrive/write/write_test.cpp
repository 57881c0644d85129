#include "roadbed/map/opendrive/write/write.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/tests/map/opendrive/write/written_map.h"
#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

TEST(WriteOpenDrive, ATownComesBack) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  for (const int minor : {4, 8}) expect_comes_back(town, minor);
}

TEST(WriteOpenDrive, NoLimitComesBackAsNone) {
  tests::MadeMap made = tests::straight_two_lane_road();
  const double none_mps = std::numeric_limits<double>::infinity();
  made.lane(LaneId{0}).speed_limits = {{0.0, 10.0}, {40.0, none_mps}};
  const RoadMap after = parse_map(file_of(made.build()).bytes, "written.xodr");
  std::vector<double> limits_mps;
  for (const SpeedLimit& limit : after.lane(after.find_lane("1/0/-1").value()).speed_limits) {
    limits_mps.push_back(limit.limit_mps.value());
  }
  EXPECT_EQ(limits_mps, std::vector({10.0, none_mps}));
}

TEST(WriteOpenDrive, ALanelet2CrossingComesBack) {
  expect_comes_back(load_map(tests::data_folder() / "crossing.osm"), 8);
}

// A road of one lane that begins along a curve of some length and goes on, and may have a second
// section.
std::string one_lane(const std::string& geometry, double length_m, double offset_m,
                     const std::string& second_section_m = "", double more_m = 0.0) {
  const std::string lane =
      "<center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\">"
      "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>"
      "<width sOffset=\"0\" a=\"3.2\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection>";
  std::string lanes = "<laneSection s=\"0\">" + lane;
  if (!second_section_m.empty()) lanes += "<laneSection s=\"" + second_section_m + "\">" + lane;
  return fmt::format(
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"{4}\" "
      "junction=\"-1\"><planView><geometry s=\"0\" x=\"5\" y=\"7\" hdg=\"0.3\" length=\"{0}\">"
      "{1}</geometry></planView><lanes><laneOffset s=\"0\" a=\"{2}\" b=\"0\" c=\"0\" d=\"0\"/>"
      "{3}</lanes></road></OpenDRIVE>",
      length_m, geometry, offset_m, lanes, length_m + more_m);
}

TEST(WriteOpenDrive, ARoadOfTheMapTurnsBackWhereItDoes) {
  // Tighter than its lane is wide: the inner border runs back in the bend.
  for (const double offset_m : {0.0, 3.2}) {
    const RoadMap before = parse_map(
        one_lane("<paramPoly3 aU=\"0\" bU=\"14.31\" cU=\"-11.45\" dU=\"0\" aV=\"0\" bV=\"0\" "
                 "cV=\"5.72\" dV=\"0\" pRange=\"normalized\"/>",
                 9.45, offset_m),
        "bend.xodr");
    const opendrive::OpenDriveFile file = file_of(before);
    EXPECT_LE(file.largest_error_m, 0.01) << offset_m;
    EXPECT_EQ(file.notes, std::vector<std::string>{});
    const RoadMap after = parse_map(file.bytes, "written.xodr");
    EXPECT_LE(borders_apart_m(before, after), 0.01);
    EXPECT_LE(borders_apart_m(after, before), 0.01);
  }
}

// So that the lane's middle leads back at first.
TEST(WriteOpenDrive, ARoadOfTheMapTurnsBackAsSoonAsItBegins) {
  const RoadMap before = parse_map(
      one_lane("<paramPoly3 aU=\"0\" bU=\"2.588\" cU=\"-1.363\" dU=\"0\" aV=\"0\" bV=\"0\" "
               "cV=\"-4.134\" dV=\"0\" pRange=\"normalized\"/>",
               4.632, 0.0),
      "turn.xodr");
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_LE(file.largest_error_m, 0.02);
  EXPECT_LE(borders_apart_m(before, parse_map(file.bytes, "written.xodr")), 0.02);
}

TEST(WriteOpenDrive, ARoadOfTheMapBendsBehindALongStraight) {
  const RoadMap before = parse_map(
      one_lane(
          fmt::format("<paramPoly3 aU=\"0\" bU=\"400\" cU=\"0\" dU=\"0\" aV=\"0\" bV=\"0\" "
                      "cV=\"0\" dV=\"0\" pRange=\"normalized\"/></geometry><geometry s=\"400\" "
                      "x=\"{}\" y=\"{}\" hdg=\"0.3\" length=\"100\"><arc curvature=\"0.01\"/>",
                      5.0 + 400.0 * std::cos(0.3), 7.0 + 400.0 * std::sin(0.3)),
          400.0, 0.0, "450", 100.0),
      "long.xodr");
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_LE(file.largest_error_m, 0.003);
  EXPECT_LE(borders_apart_m(before, parse_map(file.bytes, "written.xodr")), 0.003);
}

TEST(WriteOpenDrive, ASectionOfAFewCentimetresStays) {
  const RoadMap before = parse_map(one_lane("<line/>", 10.0, 0.0, "9.96"), "short.xodr");
  ASSERT_EQ(before.lanes().size(), 2u);
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_EQ(file.notes, std::vector<std::string>{});
  const RoadMap after = parse_map(file.bytes, "written.xodr");
  ASSERT_EQ(after.lanes().size(), 2u);
  EXPECT_EQ(after.graph().of(LaneId{0}).successors, std::vector{LaneId{1}});
}

TEST(WriteOpenDrive, RealMapsAreWrittenWithoutErrors) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const std::filesystem::path autoware = folder / "lanelet2/autowarefoundation+autoware_core";
  for (const std::filesystem::path& file :
       {autoware / "2km_test.osm", autoware / "intersection.osm", autoware / "road_shoulder.osm",
        autoware / "vm_03_left_hand.osm", folder / "opendrive/esmini+esmini/soderleden.xodr",
        folder / "commonroad/CommonRoad+commonroad-reachable-set/DEU_Guetersloh-20_1_T-1.xml"}) {
    SCOPED_TRACE(file);
    if (!std::filesystem::exists(file)) continue;
    const opendrive::OpenDriveFile written = file_of(load_map(file));
    EXPECT_EQ(errors_in(written), std::vector<std::string>{});
    EXPECT_LE(written.largest_error_m, 0.04);
    for (const auto& [what, count] : written.lost) EXPECT_EQ(what.find("lanes that no"), what.npos);
  }
}

TEST(WriteOpenDrive, ABorderStaysStraightOutsideOfOneThatWinds) {
  tests::MadeLanelet2 made;
  std::vector<tests::MadeLanelet2::Point> winding;
  for (int i = 0; i <= 60; ++i) winding.emplace_back(1.5 * i, 3.5 + 0.15 * std::sin(0.7 * i));
  const std::int64_t between = made.line(winding);
  made.lanelet(made.line({{0, 7}, {90, 7}}), between);
  made.lanelet(between, made.line({{0, 0}, {90, 0}}));
  const RoadMap before = parse_map(made.text(), "made.osm");
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_LE(file.largest_error_m, 0.0065);  // what a width may be off, and chords
  EXPECT_LE(borders_apart_m(parse_map(file.bytes, "written.xodr"), before), 0.0065);
}

TEST(WriteOpenDrive, ALaneThatOpensHasAWidthWhereARecordBegins) {
  // What netconvert asks for, which evaluates widths nowhere else.
  for (const double left_m : {0.0, 1.0, 3.0}) {
    tests::MadeLanelet2 made;
    const std::int64_t tip = made.node({0, 0});
    made.lanelet(made.way({tip, made.node({20, left_m})}),
                 made.way({tip, made.node({20, left_m - 3})}));
    const std::string bytes = file_of(parse_map(made.text(), "made.osm")).bytes;
    double widest_m = 0.0;
    for (std::size_t at = bytes.find("<width "); at != bytes.npos;
         at = bytes.find("<width ", at + 1)) {
      widest_m = std::max(widest_m, std::stod(bytes.substr(bytes.find("a=\"", at) + 3)));
    }
    EXPECT_GE(widest_m, 1.0) << left_m;
  }
}

TEST(WriteOpenDrive, NamesALaneThatNoRoadCanHold) {
  tests::MadeLanelet2 made;
  const auto crossing = made.line({{0, 3}, {10, -3}}), straight = made.line({{0, 0}, {10, 0}});
  made.lanelet(crossing, straight);
  made.lanelet(made.line({{0, 20}, {10, 20}}), made.line({{0, 17}, {10, 17}}));
  const RoadMap before = parse_map(made.text(), "made.osm");
  ASSERT_EQ(before.lanes().size(), 2u);
  const opendrive::OpenDriveFile file = file_of(before);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_TRUE(file.notes[0].starts_with("left out is lane " + before.lanes()[0].name));
  EXPECT_EQ(parse_map(file.bytes, "written.xodr").lanes().size(), 1u);
  EXPECT_EQ(errors_in(file), std::vector<std::string>{});
}

TEST(WriteOpenDrive, WritesTheSameBytesInAnyNumberOfThreads) {
  for (const char* name : {"town.xodr", "crossing.osm"}) {
    const RoadMap road_map = load_map(tests::data_folder() / name);
    const std::string bytes = file_of(road_map).bytes;
    for (const int threads : {1, 2, 5}) {
      EXPECT_EQ(opendrive::write_open_drive(road_map, {road_map.crs(), {}, 8, threads}).bytes,
                bytes);
    }
  }
}

TEST(WriteOpenDrive, KeepsCoordinatesAndTheirSystem) {
  const RoadMap before = load_map(tests::data_folder() / "town.xodr");
  const RoadMap after = parse_map(file_of(before).bytes, "written.xodr");
  EXPECT_EQ(after.crs(), before.crs());
  EXPECT_EQ(after.format(), "OpenDRIVE 1.8");
}

TEST(WriteOpenDrive, NamesThePlaceInItsSystemWhereAVersionHasNone) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const CrsOffset offset{.x_m = 500'000.0, .y_m = 5'400'000.0};
  const auto lost = [&](int minor) {
    const auto file = opendrive::write_open_drive(town, {"EPSG:25832", offset, minor});
    return std::ranges::count_if(file.lost, [](const auto& entry) {
      return entry.first.starts_with("place of the coordinates");
    });
  };
  EXPECT_EQ(lost(4), 1);
  EXPECT_EQ(lost(5), 0);
}

TEST(WriteOpenDrive, SignalsKeepTheirSize) {
  tests::MadeRoad road;
  road.rest = R"(<signals><signal s="50" t="-4" id="7" name="l" dynamic="yes" orientation="+"
                  zOffset="3" country="OpenDRIVE" type="1000001" subtype="-1" height="0.9"
                  width="0.3"/></signals>)";
  const RoadMap before = tests::made_map(tests::made_road(road));
  const std::string bytes = file_of(before).bytes;
  EXPECT_NE(bytes.find(R"(height="0.9" width="0.3")"), std::string::npos);
}

TEST(WriteOpenDrive, ALaneIsLeftOnlyWhereTheMapAllowsIt) {
  // Along a lane that narrows, so that its stations are not the road's.
  constexpr auto kMarks = R"(<roadMark sOffset="4" type="broken" laneChange="none"/>
                             <roadMark sOffset="45" type="none" laneChange="both"/>)";
  std::string narrowing = tests::made_lane(1, kMarks);
  narrowing.insert(narrowing.find("<roadMark"),
                   R"(<width sOffset="34" a="3.5" b="0" c="-0.0168" d="0.000448"/>
                      <width sOffset="59" a="0" b="0" c="0" d="0"/>)");
  tests::MadeRoad road;
  road.plan_view =
      R"(<geometry s="0" x="279" y="0" hdg="3.1415926" length="100"><line/></geometry>)";
  road.lanes =
      tests::made_section(0, narrowing + tests::made_lane(2), tests::made_lane(-1), kMarks);
  const RoadMap before = tests::made_map(tests::made_road(road));
  const RoadMap after = parse_map(file_of(before).bytes, "written.xodr");
  for (const Lane& lane : before.lanes()) {
    for (const auto beside : {&LaneLinks::left, &LaneLinks::right}) {
      const auto windows = [&](const RoadMap& road_map) {
        const auto& link = road_map.graph().of(lane.id).*beside;
        return link ? link->change_windows : std::vector<StationRange>{};
      };
      const auto wanted = windows(before), found = windows(after);
      ASSERT_EQ(found.size(), wanted.size()) << lane.name;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].from_s_m, wanted[i].from_s_m, 0.01) << lane.name;
        EXPECT_NEAR(found[i].to_s_m, wanted[i].to_s_m, 0.01) << lane.name;
      }
    }
  }
}

TEST(WriteOpenDrive, KnowsVersionsFrom4To8Only) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  EXPECT_THROW(static_cast<void>(file_of(town, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(file_of(town, 9)), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
