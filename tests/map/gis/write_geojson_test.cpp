#include "roadbed/map/gis/write.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "roadbed/map/gis/layers.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

using Json = nlohmann::json;

Json document_of(const RoadMap& road_map, const std::vector<std::string>& names) {
  std::vector<Layer> layers = make_layers(road_map, names);
  to_source(road_map, layers);
  return Json::parse(write_geojson(layers, {false, road_map.format(), road_map.crs()}));
}

Json features_of(const RoadMap& road_map, const std::vector<std::string>& names) {
  return document_of(road_map, names).at("features");
}

TEST(WriteGeojson, GivesEachLaneAClosedPolygonAndACentreline) {
  const Json features =
      features_of(tests::straight_two_lane_road(100.0).build(), {"lanes", "centrelines"});
  ASSERT_EQ(features.size(), 4u);
  const Json& lane = features[0];
  EXPECT_EQ(lane.at("properties").at("kind"), "lane");
  EXPECT_EQ(lane.at("properties").at("lane"), "1/0/-1");
  EXPECT_EQ(lane.at("properties").at("left"), "1/0/1");
  EXPECT_EQ(lane.at("properties").at("opposite"), "1/0/1");
  EXPECT_NEAR(lane.at("properties").at("area_m2").get<double>(), 350.0, 1e-9);
  const Json& ring = lane.at("geometry").at("coordinates").at(0);
  ASSERT_EQ(ring.size(), 5u);
  EXPECT_EQ(ring.front(), ring.back());
  const Json& centreline = features[2];
  EXPECT_EQ(centreline.at("geometry").at("type"), "LineString");
  EXPECT_EQ(centreline.at("geometry").at("coordinates"),
            Json::parse("[[0,-1.75,0],[100,-1.75,0]]"));
}

TEST(WriteGeojson, NamesLinksByLane) {
  const Json features = features_of(tests::three_roads_in_a_row().build(), {"lanes"});
  const Json& middle = features[1].at("properties");
  EXPECT_EQ(middle.at("predecessors"), Json::parse(R"(["1/0/-1"])"));
  EXPECT_EQ(middle.at("successors"), Json::parse(R"(["3/0/-1"])"));
  EXPECT_EQ(middle.at("junction"), "7");
}

TEST(WriteGeojson, SaysThatMetresAreNoLongitudeAndLatitude) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.origin_in_source = {500000, 5400000};
  const Json document = document_of(made.build(), {"centrelines"});
  EXPECT_TRUE(document.at("crs").is_null());
  EXPECT_EQ(document.at("features")[1].at("geometry").at("coordinates")[0][0], 500100.0);
  const std::vector<Layer> none;
  EXPECT_FALSE(Json::parse(write_geojson(none, {true, "", ""})).contains("crs"));  // RFC 7946
}

TEST(WriteGeojson, GivesSignalsAsPoints) {
  tests::MadeMap made = tests::straight_two_lane_road();
  Signal signal;
  signal.source_id = "5";
  signal.in_map = {30, -5};
  signal.value = 50.0;
  signal.lanes = {LaneId{0}};
  made.parts.signals.push_back(signal);
  const Json point = features_of(made.build(), {"signals"}).at(0);
  EXPECT_EQ(point.at("geometry"), Json::parse(R"({"type":"Point","coordinates":[30,-5,0]})"));
  EXPECT_EQ(point.at("properties").at("lanes"), Json::parse(R"(["1/0/-1"])"));
  EXPECT_TRUE(point.at("properties").at("heading_rad").is_null());
}

TEST(WriteGeojson, GivesSurfacesAsPolygonsWithHoles) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  made.add_lane(road, "-1", {{0, 10}, {30, 10}}, {{0, 0}, {30, 0}});
  made.add_lane(road, "-2", {{0, 30}, {30, 30}}, {{0, 20}, {30, 20}});
  made.add_lane(road, "-3", {{0, 30}, {0, 0}}, {{-10, 30}, {-10, 0}});
  made.add_lane(road, "-4", {{40, 30}, {40, 0}}, {{30, 30}, {30, 0}});
  const Json features = features_of(made.build(), {"drivable_surface", "roads"});
  ASSERT_EQ(features.size(), 2u);
  EXPECT_EQ(features[0].at("geometry").at("type"), "Polygon");
  EXPECT_EQ(features[0].at("geometry").at("coordinates").size(), 2u);
  EXPECT_NEAR(features[0].at("properties").at("area_m2").get<double>(), 1200.0, 1e-6);
  EXPECT_EQ(features[1].at("geometry").at("type"), "MultiPolygon");
  EXPECT_EQ(features[1].at("geometry").at("coordinates").at(0).size(), 2u);
}

TEST(WriteGeojson, StaysValidJsonWhereNamesAreNotUtf8) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.roads[0].source_id =
      "Stra\xdf"
      "e \"1\"";
  EXPECT_NO_THROW(features_of(made.build(), {}));
}

}  // namespace
}  // namespace roadbed::map
