#include "roadbed/map/formats/write_geojson.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

using Json = nlohmann::json;

Json features_of(const RoadMap& road_map) {
  return Json::parse(write_geojson(road_map)).at("features");
}

TEST(WriteGeojson, GivesEachLaneAClosedPolygonAndACentreline) {
  const Json features = features_of(tests::straight_two_lane_road(100.0).build());
  ASSERT_EQ(features.size(), 4u);
  const Json& lane = features[0];
  EXPECT_EQ(lane.at("properties").at("kind"), "lane");
  EXPECT_EQ(lane.at("properties").at("lane"), "1/0/-1");
  EXPECT_EQ(lane.at("properties").at("left"), "1/0/1");
  EXPECT_NEAR(lane.at("properties").at("area_m2").get<double>(), 350.0, 1e-9);
  const Json& ring = lane.at("geometry").at("coordinates").at(0);
  ASSERT_EQ(ring.size(), 5u);
  EXPECT_EQ(ring.front(), ring.back());
  const Json& centreline = features[1];
  EXPECT_EQ(centreline.at("geometry").at("type"), "LineString");
  EXPECT_EQ(centreline.at("geometry").at("coordinates"),
            Json::parse("[[0,-1.75,0],[100,-1.75,0]]"));
}

TEST(WriteGeojson, NamesLinksByLane) {
  const Json features = features_of(tests::three_roads_in_a_row().build());
  const Json& middle = features[2].at("properties");
  EXPECT_EQ(middle.at("predecessors"), Json::parse(R"(["1/0/-1"])"));
  EXPECT_EQ(middle.at("successors"), Json::parse(R"(["3/0/-1"])"));
  EXPECT_EQ(middle.at("junction"), "7");
}

TEST(WriteGeojson, NamesTheCrsAsTheSourceDoesAndNullIfItDoesNot) {
  tests::MadeMap made = tests::straight_two_lane_road();
  EXPECT_TRUE(Json::parse(write_geojson(made.build())).at("crs").is_null());
  made.parts.crs = "EPSG:25832";
  made.parts.origin_in_source = {500000, 5400000};
  const Json document = Json::parse(write_geojson(made.build()));
  EXPECT_EQ(document.at("crs").at("properties").at("name"), "EPSG:25832");
  EXPECT_EQ(document.at("features")[1].at("geometry").at("coordinates")[0][0], 500000.0);
}

TEST(WriteGeojson, GivesSignalsAsPoints) {
  tests::MadeMap made = tests::straight_two_lane_road();
  Signal signal;
  signal.source_id = "5";
  signal.in_map = {30, -5};
  signal.value = 50.0;
  signal.lanes = {LaneId{0}};
  made.parts.signals.push_back(signal);
  const Json point = features_of(made.build()).at(4);
  EXPECT_EQ(point.at("geometry"), Json::parse(R"({"type":"Point","coordinates":[30,-5]})"));
  EXPECT_EQ(point.at("properties").at("lanes"), Json::parse(R"(["1/0/-1"])"));
}

TEST(WriteGeojson, StaysValidJsonWhereNamesAreNotUtf8) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.roads[0].source_id =
      "Stra\xdf"
      "e \"1\"";
  EXPECT_NO_THROW(features_of(made.build()));
}

}  // namespace
}  // namespace roadbed::map
