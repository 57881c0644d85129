#include "roadbed/map/lanelet2/write/autoware/write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/judged_file.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::lanelet2 {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSubsetOf;

AutowareFiles written(const RoadMap& road_map) {
  return write_autoware(road_map, {road_map.crs(), road_map.offset_in_crs(), {}});
}

/// Issues of Autoware's that a file has, as errors.
std::set<std::string> issues_in(const std::string& file) {
  validation::ValidateOptions options;
  options.choice.profile = validation::Profile::autoware;
  std::set<std::string> issues;
  for (const auto& finding : judge_lanelet2(file, "lanelet2_map.osm", options).findings) {
    if (finding.severity != validation::Severity::error) continue;
    if (!finding.autoware_issue.empty()) issues.insert(finding.autoware_issue);
  }
  return issues;
}

std::string name_of(const Lane& lane) {
  const auto name = std::ranges::find(lane.attributes, "name", &Attributes::value_type::first);
  return name == lane.attributes.end() ? lane.name : name->second;
}

/// The successors of each driving lane, by the names of the source.
std::map<std::string, std::set<std::string>> links_of(const RoadMap& road_map) {
  std::map<std::string, std::set<std::string>> links;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    std::set<std::string>& next = links[name_of(lane)];
    for (const LaneId to : road_map.graph().of(lane.id).successors) {
      if (is_drivable(road_map.lane(to).type)) next.insert(name_of(road_map.lane(to)));
    }
  }
  return links;
}

/// The value of a tag of a relation, way or node with these tags.
std::string tag(const Attributes& tags, const std::string& key) {
  const auto found = std::ranges::find(tags, key, &Attributes::value_type::first);
  return found == tags.end() ? "" : found->second;
}

std::vector<const Relation*> relations_of(const Document& document, std::string_view subtype) {
  std::vector<const Relation*> found;
  for (const Relation& relation : document.relations) {
    if (relation.subtype == subtype) found.push_back(&relation);
  }
  return found;
}

std::vector<const Way*> members_of(const Document& document, const Relation& relation,
                                   std::string_view role) {
  std::vector<const Way*> ways;
  for (const Member& member : relation.members) {
    if (member.role != role || member.kind != MemberKind::way) continue;
    ways.push_back(&document.ways[*document.way_index.find(member.id)]);
  }
  return ways;
}

// What the town's roads do not have: limits up to 50 km/h, one line between lanes of two roads that
// run beside each other, lanes as wide as nothing, and a word on who goes first without lights.
TEST(WriteAutoware, TheTownHasWhatAutowareAsksForAsFarAsItIsKnown) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  EXPECT_THAT(
      issues_in(written(town).vector_map),
      IsSubsetOf({"Lane.SpeedLimitValidity-002", "Lane.BorderSharing-001",
                  "Lane.LaneletGeometry-001", "Intersection.RightOfWayWithoutTrafficLights-005"}));
}

TEST(WriteAutoware, ARealTownHasWhatAutowareAsksForAsFarAsItIsKnown) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const RoadMap town = load_map(folder / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr");
  EXPECT_THAT(issues_in(written(town).vector_map),
              IsSubsetOf({"Lane.SpeedLimitValidity-002", "Lane.BorderSharing-001",
                          "Lane.BorderSharing-002", "Intersection.LaneletDivision-001",
                          "Intersection.RightOfWayWithoutTrafficLights-005"}));
}

TEST(WriteAutoware, LanesLeadWhereTheyDid) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  EXPECT_EQ(links_of(parse_map(written(town).vector_map, "written.osm")), links_of(town));
}

TEST(WriteAutoware, AnAutowareMapKeepsItsElementsAndCoordinatesAndGetsNoNewErrors) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto path = folder / "lanelet2/autowarefoundation+autoware_core/intersection.osm";
  const std::string source = read_file(path);
  const RoadMap road_map = load_map(path);
  const AutowareFiles files = write_autoware(road_map, {road_map.crs(), {}, source});
  EXPECT_THAT(issues_in(files.vector_map), IsSubsetOf(std::set<std::string>(issues_in(source))));
  const Document before = read_document(source, "before"),
                 after = read_document(files.vector_map, "after");
  ASSERT_GE(after.nodes.size(), before.nodes.size());
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    ASSERT_EQ(after.nodes[i].id, before.nodes[i].id);
    ASSERT_NEAR(after.places[i].local_x_m, before.places[i].local_x_m, 1e-6);
    ASSERT_NEAR(after.places[i].local_y_m, before.places[i].local_y_m, 1e-6);
  }
  for (const Relation& relation : before.relations) {
    ASSERT_TRUE(after.relation_index.find(relation.id)) << relation.id;
  }
}

TEST(WriteAutoware, LocalCoordinatesAreMetresFromTheCornerOfOneMgrsSquare) {
  tests::MadeMap made = tests::straight_two_lane_road(3000.0);
  made.parts.crs = "EPSG:32632";
  made.parts.origin_in_source = {599'000.0, 5'400'000.0};  // over the east edge of 32UNU's square
  const AutowareFiles files = written(made.build());
  const Document document = read_document(files.vector_map, "written.osm");
  ASSERT_FALSE(document.nodes.empty());
  EXPECT_THAT(files.projector_info, HasSubstr("projector_type: MGRS"));
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const NodePlace& place = document.places[i];
    int zone = 0;
    bool north = false;
    double easting_m = 0.0, northing_m = 0.0;
    GeographicLib::UTMUPS::Forward(place.latitude_deg, place.longitude_deg, zone, north, easting_m,
                                   northing_m, 32);
    EXPECT_EQ(zone, 32);
    EXPECT_NEAR(std::remainder(place.local_x_m - easting_m, 1e5), 0.0, 2e-6);
    EXPECT_NEAR(std::remainder(place.local_y_m - northing_m, 1e5), 0.0, 2e-6);
  }
  // 2 of the 3 km lie in the square to the east: the frame is that of most nodes, and goes on.
  const auto [low, high] = std::ranges::minmax(document.places, {}, &NodePlace::local_x_m);
  EXPECT_NEAR(high.local_x_m - low.local_x_m, 3000.0, 1e-5);
}

TEST(WriteAutoware, TheProjectorIsLocalWhereThePlaceIsUnknown) {
  const AutowareFiles files = written(tests::straight_two_lane_road().build());
  EXPECT_EQ(files.projector_info, "projector_type: Local\n");
  EXPECT_THAT(files.notes, Contains(HasSubstr("projector Local")));
}

TEST(WriteAutoware, TheFileIsNeverToBeUploaded) {
  EXPECT_THAT(written(tests::straight_two_lane_road().build()).vector_map,
              HasSubstr("upload=\"never\""));
}

// Of elements with one id the first is the file's; a light may be a way of nothing.
TEST(WriteAutoware, ADamagedMapIsWrittenAsFarAsItIsOne) {
  std::string source = read_file(tests::data_folder() / "crossing.osm");
  const std::string end = "</osm>";
  const std::size_t lanelet = source.find("<relation");
  const std::string again =
      source.substr(lanelet, source.find("</relation>", lanelet) + 11 - lanelet);
  const std::size_t light = source.find("v=\"traffic_light\"");
  std::size_t way = source.rfind("<way", light);
  while (true) {  // without its nodes
    const std::size_t node = source.find("<nd", way);
    if (node > source.find("</way>", way)) break;
    source.erase(node, source.find("/>", node) + 2 - node);
  }
  source.insert(source.rfind(end), again);
  const RoadMap road_map = parse_map(source, "damaged.osm");
  const AutowareFiles files = write_autoware(road_map, {road_map.crs(), {}, source});
  EXPECT_EQ(parse_map(files.vector_map, "written.osm").lanes().size(), 24U);
}

/// A light beyond the middle road of three, for the first of them, that faces as said.
RoadMap lit_road(double heading_rad) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  Signal light;
  light.source_id = "9";
  light.dynamic = true;
  light.in_map = {100.0, 0.0};
  light.z_m = 5.0;
  light.heading_rad = heading_rad;
  light.lanes = {LaneId{0}};
  made.parts.signals.push_back(light);
  return made.build();
}

TEST(WriteAutoware, ALightIsNamedBehindItsStopLineAndHasBulbsRedOnTop) {
  const Document document = read_document(written(lit_road(M_PI)).vector_map, "written.osm");
  const auto elements = relations_of(document, "traffic_light");
  ASSERT_EQ(elements.size(), 1U);
  std::vector<std::string> users;
  for (const Relation& relation : document.relations) {
    for (const Member& member : relation.members) {
      if (member.id != elements[0]->id) continue;
      users.push_back(tag(attributes_of(relation.tags), "name"));
    }
  }
  EXPECT_EQ(users, std::vector<std::string>{"2/0/-1"});  // the road in the junction
  const auto bulbs = members_of(document, *elements[0], "light_bulbs");
  ASSERT_EQ(bulbs.size(), 1U);
  std::vector<std::pair<std::string, double>> seen;
  for (const std::uint32_t node : bulbs[0]->nodes) {
    seen.emplace_back(tag(document.tags_of(document.nodes[node].at), "color"),
                      document.nodes[node].in_map.z());
  }
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].first, "red");
  EXPECT_EQ(seen[2].first, "green");
  EXPECT_NEAR(seen[0].second, 5.0 + 5.0 / 6.0, 1e-3);  // of a body of 1 m
  EXPECT_NEAR(seen[2].second, 5.0 + 1.0 / 6.0, 1e-3);
  const auto lines = members_of(document, *elements[0], "ref_line");
  ASSERT_EQ(lines.size(), 1U);
  for (const std::uint32_t node : lines[0]->nodes) {  // where the junction begins
    EXPECT_NEAR(document.nodes[node].in_map.x() + document.origin_in_source.x(), 50.0, 1e-5);
  }
}

TEST(WriteAutoware, WithoutAnIntersectionVehiclesStopBesideTheirLight) {
  tests::MadeMap made = tests::straight_two_lane_road();
  for (const double x_m : {30.0, 60.0}) {
    Signal light;
    light.source_id = std::to_string(static_cast<int>(x_m));
    light.dynamic = true;
    light.in_map = {x_m, -6.0};
    light.heading_rad = M_PI;
    light.lanes = {LaneId{0}};
    made.parts.signals.push_back(light);
  }
  const Document document = read_document(written(made.build()).vector_map, "written.osm");
  std::set<double> places_m;
  for (const Relation* element : relations_of(document, "traffic_light")) {
    for (const std::uint32_t node : members_of(document, *element, "ref_line").at(0)->nodes) {
      places_m.insert(std::round(document.nodes[node].in_map.x() + document.origin_in_source.x()));
    }
  }
  EXPECT_EQ(places_m, (std::set{30.0, 60.0}));
}

TEST(WriteAutoware, ALightRunsFromLeftToRightAsItsDriversSeeItHoweverItIsTurned) {
  for (const double heading_rad : {0.0, M_PI}) {
    const AutowareFiles files = written(lit_road(heading_rad));
    const Document document = read_document(files.vector_map, "written.osm");
    const auto elements = relations_of(document, "traffic_light");
    ASSERT_EQ(elements.size(), 1U);
    const auto lights = members_of(document, *elements[0], "refers");
    ASSERT_EQ(lights.size(), 1U);
    const Eigen::Vector3d along = document.nodes[lights[0]->nodes.back()].in_map -
                                  document.nodes[lights[0]->nodes.front()].in_map;
    EXPECT_NEAR(along.y(), -0.3, 1e-5);  // the drivers go east: right is south
    const bool turned = std::ranges::any_of(files.notes, [](const std::string& note) {
      return note.find("turned round") != note.npos;
    });
    EXPECT_EQ(turned, heading_rad == 0.0);
  }
}

TEST(WriteAutoware, ACrosswalkIsALaneletAcrossTheRoadThatNamesIt) {
  tests::MadeMap made = tests::straight_two_lane_road();
  MapObject crosswalk;
  crosswalk.source_id = "5";
  crosswalk.type = "crosswalk";
  crosswalk.outline_in_map = {{40.0, -5.0}, {44.0, -5.0}, {44.0, 5.0}, {40.0, 5.0}};
  made.parts.objects.push_back(crosswalk);
  const Document document = read_document(written(made.build()).vector_map, "written.osm");
  const Relation* lanelet = nullptr;
  const Relation* element = nullptr;
  for (const Relation* one : relations_of(document, "crosswalk")) {
    (one->type == "lanelet" ? lanelet : element) = one;
  }
  ASSERT_TRUE(lanelet != nullptr && element != nullptr);
  const auto x_of = [&](std::string_view role) {
    const Way& border = *members_of(document, *lanelet, role).at(0);
    return document.nodes[border.nodes[0]].in_map.x() + document.origin_in_source.x();
  };
  EXPECT_NEAR(std::abs(x_of("left") - x_of("right")), 4.0, 1e-5);
  const auto names = [&](const Relation& relation) {
    return std::ranges::any_of(relation.members,
                               [&](const Member& member) { return member.id == element->id; });
  };
  EXPECT_EQ(std::ranges::count_if(relations_of(document, "road"),
                                  [&](const Relation* road) { return names(*road); }),
            2);
}

TEST(WriteAutoware, WhatAutowareHasNoPlaceForIsCounted) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.lane(LaneId{0}).speed_limits = {{0.0, 10.0}, {40.0, 5.0}};
  made.lane(made.add_lane(RoadId{0}, "9", {{0.0, 30.0}, {100.0, 30.0}},
                          {{0.0, 28.0}, {100.0, 28.0}}, LaneType::sidewalk))
      .participants = Participants{Participant::pedestrian};
  const AutowareFiles files = written(made.build());
  EXPECT_THAT(files.lost,
              testing::ElementsAre(
                  testing::Pair("sidewalks that lie beside no road", std::size_t{1}),
                  testing::Pair("changes of the speed limit along a lane, which has the least",
                                std::size_t{1})));
}

}  // namespace
}  // namespace roadbed::map::lanelet2
