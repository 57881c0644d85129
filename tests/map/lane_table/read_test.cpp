#include "roadbed/map/lane_table/read.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/write.h"
#include "roadbed/map/lane_table/table.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/endless_rows.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using lane_table::Mapping;
using lane_table::read_mapping;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

Mapping columns(const std::string& text) { return read_mapping(text, "columns.json"); }

RoadMap read(const std::string& bytes, const std::string& mapping) {
  return RoadMap(lane_table::read(bytes, "lanes.geojson", columns(mapping)));
}

RoadMap example() {
  return RoadMap(lane_table::read(read_file(tests::data_folder() / "lanes.geojson"),
                                  "lanes.geojson",
                                  columns(read_file(tests::data_folder() / "lanes_columns.json"))));
}

std::string collection(const std::string& features) {
  return R"({"type":"FeatureCollection","crs":null,"features":[)" + features + "]}";
}

std::string feature(const std::string& type, const std::string& coordinates,
                    const std::string& properties) {
  return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":")" + type +
         R"(","coordinates":)" + coordinates + "}}";
}

const Lane& lane_of(const RoadMap& road_map, const std::string& name) {
  return road_map.lane(road_map.find_lane(name).value());
}

std::vector<std::string> successors(const RoadMap& road_map, const std::string& name) {
  std::vector<std::string> found;
  for (const LaneId id : road_map.graph().of(lane_of(road_map, name).id).successors) {
    found.push_back(road_map.lane(id).name);
  }
  return found;
}

std::string refusal(const std::string& bytes, const std::string& mapping) {
  return tests::refusal_of([&] { read(bytes, mapping); });
}

TEST(LaneTable, ExampleHasWidthsTypesLimitsLinksAndNeighbours) {
  const RoadMap road_map = example();
  EXPECT_EQ(road_map.crs(), "EPSG:25832");
  EXPECT_EQ(road_map.lanes().size(), 6u);
  const Lane& east = lane_of(road_map, "east");
  EXPECT_NEAR(east.width_m(30.0), 3.5, 1e-9);
  EXPECT_NEAR(east.length_m(), 60.0, 1e-9);
  EXPECT_NEAR(east.least_speed_limit_mps().value(), 50.0 / 3.6, 1e-9);
  EXPECT_EQ(lane_of(road_map, "path").type, LaneType::biking);
  EXPECT_EQ(lane_of(road_map, "path").least_speed_limit_mps(), std::nullopt);
  EXPECT_THAT(successors(road_map, "east"), ElementsAre("bend"));
  EXPECT_THAT(successors(road_map, "bend"), ElementsAre("north"));
  const LaneLinks& links = road_map.graph().of(east.id);
  EXPECT_EQ(road_map.lane(links.left.value().lane).name, "east2");
  EXPECT_TRUE(links.left.value().change_allowed());
  EXPECT_THAT(east.attributes, Contains(Pair("kind", "street")));
}

TEST(LaneTable, BordersBesideACentrelineKeepTheirDistance) {
  const RoadMap road_map = example();
  const Lane& bend = lane_of(road_map, "bend");
  for (const LaneLine* line : {&bend.left, &bend.right}) {
    const auto& points = line->in_map.points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Eigen::Vector2d middle = 0.5 * (points[i] + points[i + 1]);
      EXPECT_NEAR(std::abs(bend.centre.in_map.project(middle).d_m), 1.75, 1e-6);
    }
  }
}

TEST(LaneTable, ABordersLayerHasTwoRowsALane) {
  const std::string left = R"("lane":"a","side":"left")", right = R"("lane":"a","side":"right")";
  const std::string mapping = R"({"drawing":"borders","lane":"lane","side":"side"})";
  const RoadMap road_map =
      read(collection(feature("LineString", "[[0,3,1],[10,3,2]]", left) + "," +
                      feature("LineString", "[[0,0,1],[10,0,2]]", right) + "," +
                      feature("LineString", "[[0,0],[10,0]]", R"("lane":"b","side":"right")") +
                      "," + feature("LineString", "[[0,0],[10,0]]", R"("side":"up")")),
           mapping);
  ASSERT_EQ(road_map.lanes().size(), 1u);
  EXPECT_THAT(road_map.lanes()[0].left.z_m, ElementsAre(1.0, 2.0));
  EXPECT_DOUBLE_EQ(road_map.lanes()[0].width_m(5.0), 3.0);
  EXPECT_EQ(road_map.import_diagnostics().size(), 2u);
}

TEST(LaneTable, APolygonIsCutAtTheEdgesAcrossItsDirection) {
  const std::string ring = "[[[0,0],[20,0],[40,5],[40,9],[20,4],[0,4],[0,0]]]";
  std::string turned = "[[[0,0],[0,4],[20,4],[40,9],[40,5],[20,0],[0,0]]]";
  for (const std::string& outline : {ring, turned}) {
    const RoadMap east = read(collection(feature("Polygon", outline, R"("to":80)")),
                              R"({"drawing":"polygon","heading_deg":"to"})");
    const Lane& lane = east.lanes()[0];
    EXPECT_THAT(lane.right.in_map.points(),
                ElementsAre(Eigen::Vector2d(0, 0), Eigen::Vector2d(20, 0), Eigen::Vector2d(40, 5)));
    EXPECT_THAT(lane.left.in_map.points(),
                ElementsAre(Eigen::Vector2d(0, 4), Eigen::Vector2d(20, 4), Eigen::Vector2d(40, 9)));
    const RoadMap west = read(collection(feature("Polygon", outline, "")),
                              R"({"drawing":"polygon","heading_deg":260})");
    EXPECT_EQ(west.lanes()[0].left.in_map.points().front(), Eigen::Vector2d(40, 5));
    EXPECT_NEAR(geometry::signed_area_m2(west.lanes()[0].polygon), 160.0, 1e-9);
  }
}

TEST(LaneTable, EndsThatCoincideAreLinkedWhereNoColumnSaysSo) {
  const std::string a = feature("LineString", "[[0,0],[10,0]]", R"("id":"a")");
  const std::string b = feature("LineString", "[[10.05,0],[20,0]]", R"("id":"b")");
  const std::string mapping = R"({"lane":"id","width_m":3,"link_m":)";
  EXPECT_THAT(successors(read(collection(a + "," + b), mapping + "0.1}"), "a"), ElementsAre("b"));
  EXPECT_THAT(successors(read(collection(a + "," + b), mapping + "0.04}"), "a"), IsEmpty());
}

TEST(LaneTable, DegreesBecomeMetresOfTheUtmZone) {
  const RoadMap road_map = read(R"({"type":"FeatureCollection","features":[)" +
                                    feature("LineString", "[[9.0,48.7],[9.001,48.7]]", "") + "]}",
                                R"({"width_m":3})");
  EXPECT_EQ(road_map.crs(), "EPSG:32632");
  EXPECT_NEAR(road_map.lanes()[0].length_m(), 73.62, 0.05);
}

/// The lanes of a map as a GeoPackage of this program's own, and their polygons read from it.
TEST(LaneTable, AGeoPackageGivesTheLanesThatItHolds) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  std::vector<Layer> layers{make_layer(town, "centrelines"), make_layer(town, "lanes")};
  to_source(town, layers);
  std::string bytes = write_geopackage(layers, "EPSG:25832");
  bytes[18] = bytes[19] = 2;  // as QGIS leaves it: with a log beside it
  const auto table = lane_table::read_geopackage(bytes, "town.gpkg", "centrelines");
  EXPECT_EQ(table.crs, "EPSG:25832");
  ASSERT_EQ(table.rows.size(), town.lanes().size());
  const std::string mapping = R"({"layer":"centrelines","lane":"lane","type":"type","width_m":3})";
  const RoadMap read_again = read(bytes, mapping);
  for (const Lane& lane : town.lanes()) {
    const Lane& again = lane_of(read_again, lane.name);
    EXPECT_EQ(again.type, lane.type);
    const Eigen::Vector2d here = town.to_source(lane.centre.in_map.points().front());
    const Eigen::Vector2d there = read_again.to_source(again.centre.in_map.points().front());
    EXPECT_LT((here - there).norm(), 1e-6) << lane.name;
  }
  EXPECT_THAT(refusal(bytes, R"({"width_m":3})"), HasSubstr("layers: centrelines, lanes"));
  EXPECT_THAT(refusal(bytes, R"({"width_m":3,"layer":"x"})"), HasSubstr("the layer \"x\""));
  for (std::size_t cut : {17u, 4096u, 20'000u}) {
    EXPECT_THROW(read(bytes.substr(0, cut), mapping), InputError) << cut;
  }
}

TEST(LaneTable, AGeoPackageWithMoreRowsThanItCanHoldIsRefused) {
  const RoadMap ramp = load_map(tests::data_folder() / "ramp.xodr");
  std::vector<Layer> layers{make_layer(ramp, "centrelines")};
  layers[0].features.resize(3);
  const std::string whole = write_geopackage(layers, "EPSG:25832");
  for (const char* table : {"centrelines", "sqlite_schema"}) {
    const std::string bytes = tests::with_endless_rows(whole, table);
    EXPECT_THROW(lane_table::read_geopackage(bytes, "f.gpkg", ""), InputError) << table;
  }
}

// What a column holds where nothing was written is stored once, of each row read.
TEST(LaneTable, AGeoPackageWhoseRowsAreMostlyWhatColumnsHoldAnywayIsRefused) {
  const RoadMap ramp = load_map(tests::data_folder() / "ramp.xodr");
  std::vector<Layer> layers{make_layer(ramp, "centrelines")};
  layers[0].features.resize(1);
  const std::string whole = write_geopackage(layers, "EPSG:25832");
  const auto with_rows = [&](int rows) {
    const std::string line =
        "475000010000000001"
        "0200000002000000" +
        std::string(32, '0') + "000000000000F03F0000000000000000";
    std::string statements = fmt::format(
        "drop trigger rtree_centrelines_geom_insert;"
        "with recursive n(i) as (select 1 union all select i + 1 from n where i < {}) insert into "
        "centrelines(geom) select x'{}' from n;",
        rows, line);
    for (int i = 0; i < 30; ++i) {
      statements +=
          fmt::format("alter table centrelines add column c{} text default '{:x>100}';", i, "");
    }
    return tests::database_after(statements, whole);
  };
  EXPECT_EQ(lane_table::read_geopackage(with_rows(1'000), "f.gpkg", "").rows.size(), 1'001u);
  EXPECT_THAT(tests::refusal_of([&] { lane_table::read_geopackage(with_rows(30'000), "f", ""); }),
              HasSubstr("more rows than it can hold"));
}

TEST(LaneTable, ASpeedThatIsNoNumberIsRemarked) {
  const auto remarks = [](const std::string& speed) {
    const std::string line = feature("LineString", "[[0,0],[9,0]]", R"("id":"a","v":)" + speed);
    const RoadMap road_map = read(collection(line), R"({"width_m":3,"speed_kmh":"v"})");
    return tests::remarks_of(road_map, "import.speed-limit");
  };
  EXPECT_THAT(remarks(R"("50")"), IsEmpty());
  EXPECT_EQ(remarks(R"("50 km/h")").size(), 1u);
}

TEST(LaneTable, ASystemInFeetIsRefused) {
  std::string line = collection(feature("LineString", "[[0,0],[9,0]]", R"("id":"a")"));
  const std::string crs = R"({"type":"name","properties":{"name":"EPSG:2263"}})";
  line.replace(line.find("null"), 4, crs);
  EXPECT_THAT(refusal(line, R"({"width_m":3})"), HasSubstr("not a projected system in metres"));
}

TEST(LaneTable, WhatIsWrongIsSaidInOneLine) {
  const std::string line = collection(feature("LineString", "[[0,0],[9,0]]", R"("id":"a")"));
  EXPECT_THAT(refusal(line, "{}"), HasSubstr("centrelines without a width"));
  EXPECT_THAT(refusal(line, R"({"width_m":"w"})"),
              HasSubstr("no row has a value in the column \"w\", needs one of: id"));
  EXPECT_THAT(refusal(line, R"({"width_m":-1})"), HasSubstr("it has no width above 0"));
  EXPECT_THAT(refusal(line, R"({"with_m":1})"), HasSubstr("with_m: is not known"));
  EXPECT_THAT(refusal(line, R"({"drawing":"dots"})"), HasSubstr("is \"dots\""));
  EXPECT_THAT(refusal(line, R"({"types":{"a":"fast"}})"), HasSubstr("\"fast\" is no type"));
  EXPECT_THAT(refusal(line, R"({"drawing":"borders"})"), HasSubstr("borders without a side"));
  EXPECT_THAT(refusal(line, R"({"drawing":"polygon"})"), HasSubstr("polygons without a direction"));
  EXPECT_THAT(refusal(line, "[]"), HasSubstr("is no object"));
  EXPECT_THAT(refusal("{}", R"({"width_m":3})"), HasSubstr("no collection of features"));
  EXPECT_THAT(refusal(collection(feature("LineString", "[[0]]", "")), R"({"width_m":3})"),
              HasSubstr("feature 1: a position"));
  const std::string far = R"({"type":"FeatureCollection","features":[)" +
                          feature("LineString", "[[9,48],[99,48]]", R"("id":"a")") + "]}";
  EXPECT_THAT(refusal(far, R"({"width_m":3})"),
              HasSubstr("row 1: longitude 99 is over 60° from the UTM zone"));
}

}  // namespace
}  // namespace roadbed::map
