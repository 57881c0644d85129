#include "roadbed/map/argoverse/read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_argoverse.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;
using tests::made_argoverse;
using tests::MadeSegment;

RoadMap parse(const std::string& text) { return parse_map(text, "made.json"); }

std::vector<std::string> names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::vector<std::string> found;
  for (const LaneId id : lanes) found.push_back(road_map.lane(id).name);
  return found;
}

const LaneLinks& links_of(const RoadMap& road_map, const std::string& name) {
  return road_map.graph().of(road_map.find_lane(name).value());
}

std::vector<std::string> rules(const RoadMap& road_map) {
  std::vector<std::string> found;
  for (const ImportDiagnostic& remark : road_map.import_diagnostics()) found.push_back(remark.rule);
  return found;
}

std::string refusal(const std::string& text) {
  return tests::refusal_of([&] { parse(text); });
}

TEST(Argoverse, IsToldByItsFirstKey) {
  for (const char* key : {"lane_segments", "pedestrian_crossings", "drivable_areas"}) {
    const std::string text = std::string("\xef\xbb\xbf \n{ \"") + key + "\" : {}}";
    EXPECT_EQ(format_of(text)->name, "Argoverse 2") << text;
  }
  EXPECT_EQ(format_of(std::string(R"({"lane_segments_":{}})"))->name, "GeoJSON");
  EXPECT_EQ(format_of(std::string(R"({"type":"FeatureCollection"})"))->name, "GeoJSON");
}

TEST(Argoverse, LanesHaveTheIdsBordersAndTypesOfTheFile) {
  const RoadMap road_map = parse(made_argoverse(
      {{.id = 7, .type = "BIKE"}, {.id = 5, .type = "BUS", .inside = "true"}, {.id = 6}}));
  ASSERT_THAT(road_map.lanes(), SizeIs(3));
  const Lane& lane = road_map.lanes()[0];
  EXPECT_EQ(lane.name, "7");
  EXPECT_EQ(lane.type, LaneType::biking);
  EXPECT_EQ(lane.participants, Participants{Participant::bicycle});
  EXPECT_EQ(road_map.lanes()[1].type, LaneType::bus);
  EXPECT_EQ(road_map.lanes()[2].type, LaneType::driving);
  EXPECT_THAT(lane.left.in_map.points(),
              ElementsAre(Eigen::Vector2d(0, 3), Eigen::Vector2d(10, 3)));
  EXPECT_THAT(lane.left.z_m, ElementsAre(1.5, 1.5));
  EXPECT_DOUBLE_EQ(lane.width_m(4.0), 3.0);
  EXPECT_FALSE(lane.junction);
  EXPECT_EQ(road_map.junction(road_map.lanes()[1].junction.value()).source_id, "5");
}

TEST(Argoverse, SuccessorsAreTheGraphAndOthersAreRemarked) {
  const RoadMap road_map =
      parse(made_argoverse({{.id = 1, .successors = "2,99"},
                            {.id = 2, .from_x_m = 10, .to_x_m = 20},
                            {.id = 3, .from_x_m = 20, .to_x_m = 30, .predecessors = "2"}}));
  EXPECT_THAT(names(road_map, links_of(road_map, "1").successors), ElementsAre("2"));
  EXPECT_THAT(names(road_map, links_of(road_map, "2").predecessors), ElementsAre("1"));
  EXPECT_THAT(links_of(road_map, "3").predecessors, IsEmpty());
  EXPECT_THAT(rules(road_map), ElementsAre("import.one-sided-link", "import.outside"));
}

TEST(Argoverse, LinksThatLeaveTheFileAreKeptWithTheirLane) {
  const RoadMap road_map =
      parse(made_argoverse({{.id = 1, .successors = "2,99", .predecessors = "98"},
                            {.id = 2, .from_x_m = 10, .to_x_m = 20}}));
  EXPECT_THAT(road_map.lanes()[0].attributes,
              ::testing::IsSupersetOf(
                  {Pair("successors_outside", "99"), Pair("predecessors_outside", "98")}));
  EXPECT_EQ(road_map.lanes()[0].attributes.size(), 4u);
  EXPECT_EQ(road_map.lanes()[1].attributes.size(), 2u);
}

struct MarkCase {
  const char* word;
  bool from_right_of_it;  ///< whether the lane to its right may be left across it, …
  bool from_left_of_it;   ///< … and the lane to its left, whose right mark it is
};

// The first word is the line on the lane's own side.
const std::vector<MarkCase> kMarks = {
    {"NONE", true, true},
    {"DASHED_WHITE", true, true},
    {"DOUBLE_DASH_YELLOW", true, true},
    {"SOLID_WHITE", false, false},
    {"SOLID_BLUE", false, false},
    {"DOUBLE_SOLID_YELLOW", false, false},
    {"SOLID_DASH_WHITE", false, false},
    {"DASH_SOLID_YELLOW", true, true},
};

TEST(Argoverse, MarksTellWhereALaneMayBeChanged) {
  for (const MarkCase& mark : kMarks) {
    const RoadMap road_map = parse(made_argoverse(
        {{.id = 1, .left_mark = mark.word, .left = "2"},
         {.id = 2, .left_y_m = 6, .right_y_m = 3, .right_mark = mark.word, .right = "1"}}));
    const Neighbour left = links_of(road_map, "1").left.value();
    const Neighbour right = links_of(road_map, "2").right.value();
    EXPECT_TRUE(left.same_direction && right.same_direction);
    EXPECT_EQ(left.change_allowed(), mark.from_right_of_it) << mark.word;
    EXPECT_EQ(right.change_allowed(), mark.from_left_of_it) << mark.word;
  }
}

TEST(Argoverse, ALaneMayBeChangedOnlyWhereTheBordersRunTogether) {
  const RoadMap road_map = parse(made_argoverse(
      {{.id = 1, .left = "2"}, {.id = 2, .left_y_m = 9, .right_y_m = 6, .right = "1"}}));
  EXPECT_FALSE(links_of(road_map, "1").left.value().change_allowed());
}

TEST(Argoverse, AnOncomingNeighbourIsOneAcrossTheLeftBorder) {
  MadeSegment oncoming{.id = 2, .from_x_m = 10, .to_x_m = 0, .left_y_m = 3, .right_y_m = 6};
  oncoming.left = "1";
  oncoming.left_mark = "DASHED_YELLOW";
  const RoadMap road_map =
      parse(made_argoverse({{.id = 1, .left_mark = "DASHED_YELLOW", .left = "2"}, oncoming}));
  const Neighbour left = links_of(road_map, "1").left.value();
  EXPECT_FALSE(left.same_direction);
  EXPECT_TRUE(left.change_allowed());
  EXPECT_EQ(road_map.lane(links_of(road_map, "2").left.value().lane).name, "1");
}

TEST(Argoverse, LanesOfAnIntersectionAreOneJunction) {
  MadeSegment across{.id = 3, .from_x_m = 40, .to_x_m = 60, .inside = "true"};
  MadeSegment crossing{.id = 2, .from_x_m = 5, .to_x_m = 5.1, .inside = "true"};
  crossing.left_y_m = -5;
  crossing.right_y_m = 5;  // its centreline passes that of lane 9
  const RoadMap road_map =
      parse(made_argoverse({{.id = 9, .inside = "true"}, crossing, across, {.id = 4}}));
  const auto junction = [&](const char* name) {
    return road_map.lane(road_map.find_lane(name).value()).junction;
  };
  EXPECT_EQ(junction("9"), junction("2"));
  EXPECT_NE(junction("9"), junction("3"));
  EXPECT_FALSE(junction("4"));
  ASSERT_THAT(road_map.junctions(), SizeIs(2));
  EXPECT_EQ(road_map.junctions()[0].source_id, "2");  // the least id of its lanes
}

std::string point(double x, double y) {
  return "{\"x\":" + std::to_string(x) + ",\"y\":" + std::to_string(y) + ",\"z\":2}";
}

TEST(Argoverse, CrossingsAreObjectsAndDrivableAreasAreRoadAreas) {
  const std::string edge = "[" + point(0, 0) + "," + point(4, 0) + "]";
  const std::string along = "[" + point(0, 3) + "," + point(4, 3) + "]";
  const std::string against = "[" + point(4, 3) + "," + point(0, 3) + "]";
  const std::string square =
      "[" + point(0, 0) + "," + point(0, 5) + "," + point(5, 5) + "," + point(5, 0) + "]";
  const std::string more = R"(,"pedestrian_crossings":{"1":{"id":1,"edge1":)" + edge +
                           R"(,"edge2":)" + along + R"(},"2":{"id":2,"edge1":)" + edge +
                           R"(,"edge2":)" + against + R"(}},"drivable_areas":{"3":{"id":3,)" +
                           R"("area_boundary":)" + square + R"(,"note":1}},"extra":[])";
  const RoadMap road_map = parse(made_argoverse({{.id = 1}}, more));
  ASSERT_THAT(road_map.objects(), SizeIs(2));
  for (const MapObject& object : road_map.objects()) {
    EXPECT_EQ(object.type, "crosswalk");
    EXPECT_DOUBLE_EQ(geometry::signed_area_m2(object.outline_in_map), 12.0) << object.source_id;
    EXPECT_EQ(object.in_map, Eigen::Vector2d(2.0, 1.5));
    EXPECT_EQ(object.z_m, 2.0);
  }
  ASSERT_THAT(road_map.areas(), SizeIs(1));
  EXPECT_TRUE(road_map.areas()[0].is_road);
  EXPECT_DOUBLE_EQ(geometry::signed_area_m2(road_map.areas()[0].in_map[0].outer), 25.0);
  std::map<std::string, std::size_t> unused;
  for (const UnusedContent& content : road_map.unused()) unused[content.name] = content.count;
  EXPECT_THAT(unused, ElementsAre(Pair("drivable_areas/note", 1), Pair("extra", 1)));
}

TEST(Argoverse, TheFilesNameSaysTheCity) {
  const std::string text = made_argoverse({{.id = 1}});
  const RoadMap road_map = parse_map(text, "a/log_map_archive_77____PIT_city_57819.json");
  EXPECT_EQ(road_map.crs(), "EPSG:32617");
  // As pyproj places the origin that the data set's package gives.
  EXPECT_NEAR(road_map.offset_in_crs().x_m, 583710.0070315006, 1e-3);
  EXPECT_NEAR(road_map.offset_in_crs().y_m, 4477259.999832617, 1e-3);
  EXPECT_THAT(road_map.attributes(), ElementsAre(Pair("log_id", "77"), Pair("city", "PIT")));
  EXPECT_EQ(parse_map(text, "log_map_archive_77.json").crs(), "");
  EXPECT_EQ(parse_map(text, "log_map_archive_77____NYC_city_1.json").crs(), "");
}

TEST(Argoverse, FaultyLanesAreRemarkedAndLeftOut) {
  MadeSegment still{.id = 4, .to_x_m = 0};
  MadeSegment swapped{.id = 5, .left_y_m = 0, .right_y_m = 3};
  std::string text = made_argoverse(
      {{.id = 1}, {.id = 1, .type = "TRAM"}, still, swapped, {.id = 6, .type = "TRAM"}});
  const RoadMap road_map = parse(text);
  EXPECT_THAT(road_map.lanes(), SizeIs(3));
  EXPECT_THAT(rules(road_map), ElementsAre("import.lane-id", "import.empty-lane",
                                           "import.swapped-borders", "import.lane-type"));
}

TEST(Argoverse, WhatCannotBeUsedIsSaidInOneLine) {
  const std::string whole = made_argoverse({{.id = 12}});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    return refusal(text);
  };
  EXPECT_THAT(with(R"("id":12)", R"("id":"a")"),
              testing::StartsWith("made.json: lane segment 12: \"id\" is no id, needs a whole"));
  EXPECT_THAT(with(R"("id":12)", R"("id":18446744073709551615)"), HasSubstr("is no id"));
  EXPECT_THAT(with(R"("x":0)", R"("x":1e9)"), HasSubstr("a point with x = 1000000000"));
  EXPECT_THAT(with(R"("x":0)", R"("x":null)"), HasSubstr("a point without the number \"x\""));
  EXPECT_THAT(with(R"("z":1.5)", R"("z":"low")"), HasSubstr("a point without the number \"z\""));
  EXPECT_THAT(with(R"("successors":[])", R"("successors":7)"), HasSubstr("is no list"));
  EXPECT_THAT(with(R"("left_neighbor_id":null)", R"("left_neighbor_id":[])"),
              HasSubstr("\"left_neighbor_id\" is no id"));
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 1)), HasSubstr("byte"));
  EXPECT_THAT(refusal(R"({"lane_segments":[]})"), HasSubstr("\"lane_segments\" is no object"));
  EXPECT_THAT(refusal(R"({"lane_segments":{"1":7}})"), HasSubstr("\"1\" is no object"));
  EXPECT_THAT(refusal(R"({"drivable_areas":{}})"), HasSubstr("no usable lane segment"));
}

/// A folder of its own with a map and the raster beside it.
class GroundHeightBeside : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    folder_.write(name, bytes);
  }

  // float16: 0x4500 is 5, 0x4600 is 6, 0x7e00 is no number.
  void write_raster(const std::string& shape) const {
    const std::string header =
        "{'descr': '<f2', 'fortran_order': False, 'shape': (" + shape + "), }\n";
    std::string bytes = "\x93NUMPY";
    bytes += {'\1', '\0', static_cast<char>(header.size()), '\0'};
    bytes += header;
    bytes += {'\x00', '\x45', '\x00', '\x46', '\x00', '\x7e',
              '\x00', '\x45', '\x00', '\x45', '\x00', '\x45'};
    write("m_ground_height_surface____PIT.npy", bytes);
  }

  RoadMap load() const {
    MadeSegment segment{.id = 1, .from_x_m = 100, .to_x_m = 105};
    segment.left_y_m = 203;
    segment.right_y_m = 200;
    segment.z = "";
    write("log_map_archive_m.json", made_argoverse({segment}));
    return load_map(folder_.path() / "log_map_archive_m.json");
  }

  tests::TemporaryFolder folder_;
};

TEST_F(GroundHeightBeside, GivesPointsWithoutAHeightTheirs) {
  write("m___img_Sim2_city.json", R"({"R":[1.0,0.0,0.0,1.0],"t":[-99.0,-199.0],"s":0.25})");
  write_raster("2, 3");
  const RoadMap road_map = load();
  const Lane& lane = road_map.lanes()[0];
  // Columns (100 − 99)/4 = 0 and (105 − 99)/4 = 1, rows (200 − 199)/4 = 0 and (203 − 199)/4 = 1.
  EXPECT_THAT(lane.right.z_m, ElementsAre(5.0, 6.0));
  EXPECT_THAT(lane.left.z_m, ElementsAre(5.0, 5.0));
  EXPECT_THAT(road_map.attributes(),
              Contains(Pair("ground_height", "m_ground_height_surface____PIT.npy")));
  EXPECT_THAT(rules(road_map), Contains("import.ground-height"));
}

TEST_F(GroundHeightBeside, IsLeftAloneWithoutItsTransformAndRefusedWhereItIsBroken) {
  write_raster("2, 3");
  EXPECT_THAT(load().lanes()[0].right.z_m, ElementsAre(0.0, 0.0));
  write("m___img_Sim2_city.json", R"({"R":[1.0,0.0,0.0],"t":[-99.0,-199.0],"s":0.25})");
  EXPECT_THROW(load(), InputError);
  write("m___img_Sim2_city.json", R"({"R":[1.0,0.0,0.0,1.0],"t":[-99.0,-199.0],"s":0.25})");
  write_raster("2, 4");
  EXPECT_THROW(load(), InputError);
  write_raster("18446744073709551615, 3");
  EXPECT_THROW(load(), InputError);
  write_raster("6,");
  EXPECT_THROW(load(), InputError);
}

using Json = nlohmann::json;

std::set<std::string> inside(const Json& ids, const Json& segments) {
  std::set<std::string> found;
  for (const Json& id : ids) {
    const std::string name = std::to_string(id.get<std::int64_t>());
    if (segments.contains(name)) found.insert(name);
  }
  return found;
}

std::string beside(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  return neighbour ? road_map.lane(neighbour->lane).name : "";
}

std::string only(const std::set<std::string>& ids) { return ids.empty() ? "" : *ids.begin(); }

void expect_same(const RoadMap& road_map, const Json& segments) {
  ASSERT_EQ(road_map.lanes().size(), segments.size());
  for (const auto& [id, segment] : segments.items()) {
    const LaneLinks& links = links_of(road_map, id);
    const auto successors = names(road_map, links.successors);
    EXPECT_EQ(std::set<std::string>(successors.begin(), successors.end()),
              inside(segment["successors"], segments));
    for (const bool left : {true, false}) {
      const Json& named = segment[left ? "left_neighbor_id" : "right_neighbor_id"];
      const Json list = named.is_null() ? Json::array() : Json::array({named});
      EXPECT_EQ(beside(road_map, left ? links.left : links.right), only(inside(list, segments)));
    }
    const Lane& lane = road_map.lane(road_map.find_lane(id).value());
    EXPECT_EQ(lane.junction.has_value(), segment["is_intersection"].get<bool>());
    EXPECT_EQ(lane.left.in_map.points().size(), segment["left_lane_boundary"].size());
  }
}

TEST(ArgoverseReal, EveryLaneSegmentIsThereWithItsLinks) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::size_t maps = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "argoverse2")) {
    if (!entry.path().filename().string().starts_with("log_map_archive_")) continue;
    SCOPED_TRACE(entry.path().filename());
    const Json file = Json::parse(read_file(entry.path()));
    const RoadMap road_map = load_map(entry.path());
    expect_same(road_map, file["lane_segments"]);
    EXPECT_EQ(road_map.objects().size(), file["pedestrian_crossings"].size());
    EXPECT_EQ(road_map.areas().size(), file["drivable_areas"].size());
    ++maps;
  }
  EXPECT_GE(maps, 3u);
}

}  // namespace
}  // namespace roadbed::map
