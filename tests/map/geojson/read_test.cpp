#include "roadbed/map/geojson/read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "roadbed/map/derived/surface.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;
using testing::SizeIs;

RoadMap surface() { return load_map(tests::data_folder() / "surface.geojson"); }

RoadMap parse(const std::string& text) { return parse_map(text, "made.geojson"); }

std::string polygon(const std::string& rings) {
  return R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":)" +
         rings + "}}";
}

std::string in_metres(const std::string& features) {
  return R"({"type":"FeatureCollection","crs":null,"features":[)" + features + "]}";
}

const std::string kRoad = "[[[0,0],[100,0],[100,8],[0,8],[0,0]]]";

// Shoelace over positions in metres east and north, by the radii of the ellipsoid there.
double area_on_ellipsoid_m2(const geometry::Polygon& in_utm) {
  constexpr double scale = 0.9996;  // of UTM at its central meridian, where the surface lies
  return geometry::area_m2(in_utm) / (scale * scale);
}

TEST(GeoJsonSurface, LongitudeAndLatitudeBecomeMetresOfTheUtmZone) {
  const RoadMap road_map = surface();
  EXPECT_EQ(road_map.format(), "GeoJSON");
  EXPECT_EQ(road_map.crs(), "EPSG:32632");
  ASSERT_THAT(road_map.areas(), SizeIs(2));
  EXPECT_TRUE(road_map.areas()[0].is_road);
  EXPECT_EQ(road_map.areas()[0].source_id, "main road");
  EXPECT_EQ(road_map.areas()[0].type, "residential");
  EXPECT_THAT(road_map.areas()[1].attributes, Contains(Pair("name", "side road")));
}

TEST(GeoJsonSurface, AreasAgreeWithTheirPlan) {
  const RoadMap road_map = surface();
  const geometry::Polygon& ring = road_map.areas()[0].in_map.at(0);
  ASSERT_THAT(ring.holes, SizeIs(1));
  const double island_m2 = 0.5 * 32 * 7.0 * 7.0 * std::sin(2 * M_PI / 32);
  EXPECT_NEAR(area_on_ellipsoid_m2({{ring.holes[0].rbegin(), ring.holes[0].rend()}, {}}), island_m2,
              1e-2);
  EXPECT_LT(geometry::signed_area_m2(ring.holes[0]), 0.0);
  const double mouth_m = 18.0 * std::cos(std::asin(3.0 / 18.0));
  EXPECT_NEAR(area_on_ellipsoid_m2(road_map.areas()[1].in_map.at(0)), 6.0 * (70.0 - mouth_m), 1e-2);
}

TEST(GeoJsonSurface, CentrelinesRunThroughTheRoundaboutAndUpTheSideRoad) {
  const RoadMap road_map = surface();
  ASSERT_THAT(road_area_surface(road_map), SizeIs(1));
  const auto lines = road_centrelines(road_map);
  // Three arms, three stretches of the ring.
  EXPECT_THAT(lines, SizeIs(6));
  double length_m = 0.0, widest_m = 0.0;
  for (const auto& line : lines) {
    length_m += line.line.length_m();
    for (const double width_m : line.width_m) widest_m = std::max(widest_m, width_m);
  }
  const double ring_m = 2 * M_PI * 0.5 * (18.0 + 7.0), arms_m = 2 * (80 - 4 - 12.5) + 70 - 3 - 12.5;
  EXPECT_NEAR(length_m, ring_m + arms_m, 8.0);
  EXPECT_NEAR(widest_m, 11.0, 2.0);
}

TEST(GeoJsonSurface, MetresStandAsTheyAreWhereCrsIsNullOrNamed) {
  const RoadMap unknown = parse(in_metres(polygon(kRoad)));
  EXPECT_EQ(unknown.crs(), "");
  EXPECT_NEAR(geometry::area_m2(unknown.areas()[0].in_map[0]), 800.0, 1e-9);
  const RoadMap named = parse(
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"features":[)" +
      polygon("[[[500000,5400000],[500000,5400010],[500010,5400010],[500000,5400000]]]") + "]}");
  EXPECT_EQ(named.crs(), "urn:ogc:def:crs:EPSG::25832");
  EXPECT_EQ(named.origin_in_source(), Eigen::Vector2d(500000, 5400000));
  EXPECT_GT(geometry::signed_area_m2(named.areas()[0].in_map[0].outer), 0.0) << "turned round";
}

TEST(GeoJsonSurface, NamedLongitudeAndLatitudeAreProjectedToo) {
  const RoadMap road_map = parse(
      R"({"type":"Feature","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},"properties":{},"geometry":{"type":"MultiPolygon","coordinates":[[[[151,-33],[151.001,-33],[151.001,-33.001],[151,-33]]]]}})");
  EXPECT_EQ(road_map.crs(), "EPSG:32756");
  const double metres_per_degree = 111'000.0;
  EXPECT_NEAR(geometry::area_m2(road_map.areas()[0].in_map[0]),
              0.5 * std::pow(0.001 * metres_per_degree, 2) * std::cos(33 * M_PI / 180), 100.0);
}

TEST(GeoJsonSurface, ThePolygonWithABadRingIsLeftOutAndTheRingNamed) {
  const RoadMap road_map = parse(
      in_metres(polygon(kRoad) + "," + polygon("[[[0,0],[50,50],[50,0],[0,50],[0,0]]]") + "," +
                polygon("[[[0,0],[100,0],[100,90],[0,90],[0,0]],[[1,1],[2,1],[2,2],[1,1]],"
                        "[[200,1],[210,1],[210,2],[200,1]]]")));
  EXPECT_THAT(road_map.areas(), SizeIs(1));
  ASSERT_THAT(road_map.import_diagnostics(), SizeIs(2));
  EXPECT_EQ(road_map.import_diagnostics()[0].element, "feature 2, polygon 1");
  EXPECT_THAT(road_map.import_diagnostics()[0].message, HasSubstr("outer ring: its edges cross"));
  EXPECT_EQ(road_map.import_diagnostics()[1].element, "feature 3, polygon 1");
  EXPECT_THAT(road_map.import_diagnostics()[1].message, HasSubstr("hole 2: it lies outside"));
}

TEST(GeoJsonSurface, OtherGeometriesAreCounted) {
  const RoadMap road_map = parse(in_metres(
      polygon(kRoad) +
      R"(,{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}})"));
  ASSERT_THAT(road_map.unused(), SizeIs(1));
  EXPECT_EQ(road_map.unused()[0].name, "geometry/Point");
}

std::string message_of(const std::string& text) {
  return tests::refusal_of([&] { parse(text); });
}

TEST(GeoJsonSurface, UnusableFilesAreRefusedWithTheirPlace) {
  EXPECT_THAT(message_of("{\"type\":"), HasSubstr("byte 9"));
  EXPECT_THAT(message_of("{}"), HasSubstr("no polygon"));
  const std::string deep(100'000, '[');
  EXPECT_THAT(message_of("{\"type\":\"Feature\",\"properties\":{\"a\":" + deep),
              HasSubstr("too deeply"));
  EXPECT_THAT(message_of(R"({"type":"FeatureCollection"})"), HasSubstr("features"));
  EXPECT_THAT(message_of(R"({"type":"FeatureCollection","features":[7]})"), HasSubstr("feature 1"));
  EXPECT_THAT(message_of(in_metres(polygon("[[[0,0],[1,\"a\"],[1,1],[0,0]]]"))),
              HasSubstr("not two numbers"));
  EXPECT_THAT(message_of(in_metres(polygon("[[[0,0],[1e300,0],[1,1],[0,0]]]"))),
              HasSubstr("beyond any road"));
  EXPECT_THAT(message_of(in_metres(polygon("[[[0,0],[1e999,0],[1,1],[0,0]]]"))),
              HasSubstr("number"));
  EXPECT_EQ(message_of(R"({"type":"Polygon","coordinates":[[[9,48],[9.1,48],[9,48.1],[9,48]]]})"),
            "accepted");
  EXPECT_THAT(
      message_of(R"({"type":"Polygon","coordinates":[[[9,48],[69.1,48],[9,48.1],[9,48]]]})"),
      HasSubstr("feature 1, polygon 1: longitude 69.1 is over 60° from the UTM zone"));
  EXPECT_THAT(message_of(R"({"type":"Polygon","coordinates":[[[500000,5400000],[1,1],[2,1]]]})"),
              HasSubstr("no longitude and latitude"));
  EXPECT_THAT(message_of(in_metres(polygon("[[[0,0],[50,50],[50,0],[0,50],[0,0]]]"))),
              HasSubstr("edges cross"));
}

}  // namespace
}  // namespace roadbed::map
