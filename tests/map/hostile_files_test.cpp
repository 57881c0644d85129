// Hostile Lanelet2 and CommonRoad files: a clear refusal or findings, with memory bounded by the
// file's size, and in no more than linear time (these take seconds, or hours).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/map/opendrive/write/write.h"
#include "roadbed/map/sumo/write.h"
#include "roadbed/tests/support/bounded_reading.h"
#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using tests::expect_read_in_bounds;
using tests::expect_validated_in_bounds;
using tests::repeated;

std::string osm(const std::string& inside) { return "<osm>" + inside + "</osm>"; }

std::string common_road(const std::string& inside) {
  return R"(<commonRoad commonRoadVersion="2020a" timeStepSize="0.1">)" + inside + "</commonRoad>";
}

const std::string kBomb =
    R"(<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">)"
    R"(<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;"><!ENTITY f SYSTEM "file:///etc/passwd">]>)";

TEST(HostileLanelet2, EmptyElementsAreRefused) {
  for (const char* element : {R"(<node id="1"/>)", R"(<node id="x"/>)", R"(<relation id="1"/>)"}) {
    expect_read_in_bounds(osm(repeated(1'200'000, element)), "next to nothing but empty elements");
  }
}

TEST(HostileLanelet2, ElementsWithEndlessContentHaveOneFinding) {
  const std::string members = R"(<relation id="1"><tag k="type" v="lanelet"/>)" +
                              repeated(300'000, R"(<member type="way" ref="1"/>)") + "</relation>";
  const std::string nodes = R"(<way id="1">)" + repeated(300'000, R"(<nd ref="1"/>)") + "</way>";
  expect_read_in_bounds(osm(members), "none of its 1 lanelets has two usable borders");
  expect_read_in_bounds(osm(nodes), "no lanelet");
  expect_validated_in_bounds(osm(members), "findings");
  expect_validated_in_bounds(osm(nodes), "findings");
}

TEST(HostileLanelet2, ManyLaneletsOnOneLongWayAreRefused) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) {
    text += "<node id=\"" + std::to_string(i) + R"(" lat="49" lon="8"/>)";
  }
  text += "<way id=\"1\">" + repeated(10'000, R"(<nd ref="1"/><nd ref="2"/>)") + "</way>";
  text += repeated(5'000, R"(<relation id="1"><member type="way" ref="1" role="left"/>)"
                          R"(<member type="way" ref="1" role="right"/>)"
                          R"(<tag k="type" v="lanelet"/></relation>)");
  expect_validated_in_bounds(osm(text), "findings");
}

TEST(HostileLanelet2, RegulationsThatReferToThemselvesAreRead) {
  const std::string text =
      R"(<node id="1" lat="49" lon="8"/><node id="2" lat="49.001" lon="8"/>
      <node id="3" lat="49" lon="8.0001"/><node id="4" lat="49.001" lon="8.0001"/>
      <way id="5"><nd ref="1"/><nd ref="2"/></way><way id="6"><nd ref="3"/><nd ref="4"/></way>
      <relation id="7"><member type="way" ref="5" role="left"/>
      <member type="way" ref="6" role="right"/>
      <member type="relation" ref="8" role="regulatory_element"/><tag k="type" v="lanelet"/>
      </relation><relation id="8"><member type="relation" ref="8" role="refers"/>
      <member type="relation" ref="7" role="refers"/><tag k="type" v="regulatory_element"/>
      <tag k="subtype" v="traffic_light"/></relation>)";
  expect_read_in_bounds(osm(text), "read 1 lanes");
}

// Each lanelet leads from a circle to one place, or from there on.
RoadMap fan(int lanelets_each_way) {
  tests::MadeLanelet2 file;
  const auto left = file.node({0, 3}), right = file.node({0, 0});
  for (int i = 0; i < 2 * lanelets_each_way; ++i) {
    const bool comes = i < lanelets_each_way;
    const double along = (i % lanelets_each_way + 0.5) / lanelets_each_way;
    const double angle_rad = std::numbers::pi * (along + (comes ? 0.5 : -0.5));
    const double x = 50.0 * std::cos(angle_rad), y = 50.0 * std::sin(angle_rad);
    const auto far_left = file.node({x, y + 3.0}), far_right = file.node({x, y});
    file.lanelet(file.way(comes ? std::vector{far_left, left} : std::vector{left, far_left}),
                 file.way(comes ? std::vector{far_right, right} : std::vector{right, far_right}));
  }
  return parse_map(file.text(), "fan.osm");
}

TEST(HostileLanelet2, LanesThatAllLeadIntoOneAnotherAreWrittenUpToALimitOfTheirNumber) {
  const auto sumo = [](const RoadMap& map) {
    return tests::refusal_of([&] { sumo::write_sumo(map, {}); });
  };
  EXPECT_EQ(sumo(fan(10)), "accepted");
  EXPECT_EQ(sumo(fan(80)),
            "SUMO: more than 180000 pairs of connections at nodes of 160 lanes, needs fewer lanes "
            "that all lead into one another; clip the map to a part without them");
  const auto open_drive = [](const RoadMap& map) {
    return tests::refusal_of([&] { opendrive::write_open_drive(map, {}); });
  };
  EXPECT_EQ(open_drive(fan(10)), "accepted");
  EXPECT_EQ(open_drive(fan(300)),
            "OpenDRIVE: 600 lanes that lead into one another in more ways than 16150, each a "
            "connecting road, needs fewer lanes that end and begin in one place; clip the map to a "
            "part without them");
}

TEST(HostileLanelet2, DepthAttributesAndEntitiesAreBounded) {
  expect_read_in_bounds("<osm>" + repeated(200'000, "<a>"), "nested deeper than 1,000");
  expect_read_in_bounds("<osm" + repeated(200'000, " a=''") + "/>", "more than 10,000 attributes");
  expect_read_in_bounds(kBomb + osm(R"(<node id="1" lat="&c;" lon="&f;"/>)"), "no lanelet");
}

TEST(HostileCommonRoad, EmptyLaneletsAreCounted) {
  const std::string empty = R"(<lanelet id="1"/>)";
  expect_read_in_bounds(common_road(repeated(1'000'000, empty)), "no usable lanelet");
  expect_validated_in_bounds(common_road(repeated(100'000, empty)), "findings");
}

TEST(HostileCommonRoad, EntitiesStayWordsAndCyclesAndFarPlacesAreSaid) {
  expect_read_in_bounds(kBomb + common_road(R"(<lanelet id="&c;&f;"/>)"), "no usable lanelet");
  const std::string bound = "<point><x>0</x><y>0</y></point><point><x>9</x><y>1e300</y></point>";
  expect_read_in_bounds(common_road(R"(<lanelet id="1"><leftBound>)" + bound +
                                    "</leftBound><rightBound>" + bound + "</rightBound></lanelet>"),
                        "a place beyond that of any road");
}

}  // namespace
}  // namespace roadbed::map
