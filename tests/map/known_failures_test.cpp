// What other converters are known to do wrong, each shown to be impossible here. Links of sidewalks
// to the end that touches are in opendrive/links_test.cpp, memory in
// hostile_files_test.cpp.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "roadbed/map/commonroad/write.h"
#include "roadbed/map/files/transverse_mercator.h"
#include "roadbed/map/lanelet2/write/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

std::string with_reference(const std::string& crs) {
  return "<geoReference><![CDATA[" + crs + "]]></geoReference>";
}

void expect_wide_m(const RoadMap& road_map, double width_m, double within_m) {
  ASSERT_GT(road_map.lanes().size(), 0u);
  for (const Lane& lane : road_map.lanes()) {
    for (const double fraction : {0.0, 0.3, 1.0}) {
      EXPECT_NEAR(lane.width_m(fraction * lane.length_m()), width_m, within_m) << lane.name;
    }
  }
}

tests::MadeRoad road_from_m(double x_m) {
  tests::MadeRoad road;
  road.x_m = x_m;
  return road;
}

// In the web's Mercator projection a metre at 48° is 1.5 units: converters that reproject to it
// make lanes that wide.
TEST(KnownFailures, NoReaderReprojects) {
  for (const char* crs : {"EPSG:3857", "+proj=utm +zone=32 +datum=WGS84", "EPSG:4326"}) {
    const RoadMap road_map =
        tests::made_map(tests::made_road(road_from_m(1'240'000.0)), with_reference(crs));
    expect_wide_m(road_map, 3.5, 1e-9);
    const auto& middle = road_map.lanes()[0].centre.in_map;
    EXPECT_NEAR(road_map.to_source(middle.at(50.0)).x(), 1'240'050.0, 1e-9);
  }
}

TEST(KnownFailures, WidthsComeBackFromLatitudeAndLongitude) {
  const RoadMap road_map = tests::made_map(
      tests::made_road(road_from_m(20'000.0)),
      with_reference("+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m"));
  std::string written = lanelet2::write_lanelet2(road_map).bytes;
  expect_wide_m(parse_map(written, "written.osm"), 3.5, 1e-4);
  // The same by latitude and longitude alone, in UTM, which is shorter by up to 0.04 %.
  for (std::size_t at; (at = written.find("local_")) != std::string::npos;) {
    written.replace(at, 6, "x");
  }
  const std::size_t crs = written.find(" crs=");
  ASSERT_NE(crs, std::string::npos);
  written.replace(crs + 1, 3, "was");
  expect_wide_m(parse_map(written, "written.osm"), 3.5, 3e-3);
}

TEST(KnownFailures, ElevationComesThroughEveryFormatWithLanes) {
  tests::MadeRoad road;
  road.elevation = R"(<elevation s="0" a="412" b="0.03" c="0" d="0"/>)";
  const RoadMap road_map = tests::made_map(
      tests::made_road(road),
      with_reference("+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m"));
  for (const std::string& written :
       {lanelet2::write_lanelet2(road_map).bytes, commonroad::write_common_road(road_map)}) {
    const RoadMap back = parse_map(written, "written");
    ASSERT_EQ(back.lanes().size(), road_map.lanes().size());
    for (const Lane& lane : back.lanes()) {
      for (const LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
        for (std::size_t i = 0; i < line->z_m.size(); ++i) {
          const double x_m = back.to_source(line->in_map.points()[i]).x();
          EXPECT_NEAR(line->z_m[i], 412.0 + 0.03 * x_m, 1e-3);
        }
      }
    }
  }
}

// A node with local_x and local_y, or without, at a place of UTM's zone 32.
std::string node(int id, const Eigen::Vector2d& local_m, bool has_local) {
  const GeographicPoint point =
      utm_grid(32, false).inverse(local_m + Eigen::Vector2d(690'000, 5'330'000));
  return fmt::format(R"(<node id="{}" lat="{:.12f}" lon="{:.12f}">{}</node>)", id,
                     point.latitude_deg, point.longitude_deg,
                     has_local
                         ? fmt::format(R"(<tag k="local_x" v="{}"/><tag k="local_y" v="{}"/>)",
                                       local_m.x(), local_m.y())
                         : "");
}

TEST(KnownFailures, OneFileHasOneCoordinateSystem) {
  const RoadMap road_map = parse_map(
      "<osm>" + node(1, {0, 3.5}, true) + node(2, {40, 3.5}, true) + node(3, {0, 0}, true) +
          node(4, {40, 0}, false) +
          R"(<way id="5"><nd ref="1"/><nd ref="2"/></way><way id="6"><nd ref="3"/><nd ref="4"/></way>
             <relation id="7"><member type="way" ref="5" role="left"/>
             <member type="way" ref="6" role="right"/><tag k="type" v="lanelet"/>
             <tag k="subtype" v="road"/></relation></osm>)",
      "mixed.osm");
  expect_wide_m(road_map, 3.5, 1e-3);
  EXPECT_NEAR(road_map.lanes()[0].length_m(), 40.0, 1e-3);
}

TEST(KnownFailures, ACityIsNotRefusedOverOneMissingRoad) {
  std::string city;
  for (int i = 0; i < 50; ++i) {
    tests::MadeRoad road;
    road.id = std::to_string(i);
    road.x_m = 100.0 * i;
    road.link =
        fmt::format(R"(<successor elementType="road" elementId="{}" contactPoint="start"/>)",
                    i == 20 ? 999 : i + 1);
    city += tests::made_road(road);
  }
  city += R"(<road id="50" length="10" junction="-1"/>)";
  const RoadMap road_map = tests::made_map(city);
  EXPECT_EQ(road_map.roads().size(), 50u);
  EXPECT_EQ(road_map.lanes().size(), 100u);
}

TEST(KnownFailures, LanesWithoutASpeedLimitAreRoutedOver) {
  tests::TwoLanes lanes;
  for (Lane& lane : lanes.made.parts.lanes) lane.speed_limits.clear();
  const RoadMap road_map = lanes.made.build();
  const planning::RouteAnswer answer =
      planning::find_route(road_map, {lanes.left, 1.0, 0.0}, {lanes.after_right, 9.0, 0.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  EXPECT_GT(answer.route->legs_of_unknown_speed, 0);
}

}  // namespace
}  // namespace roadbed::map
