#include "roadbed/map/page/map_page.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/holds.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using tests::holds;

TEST(MapPage, AsksNothingOfANetwork) {
  const std::string page = write_map_page(tests::three_roads_in_a_row().build());
  EXPECT_TRUE(holds(page, "default-src 'none'"));
  for (const std::string_view part : {" src=", "@import", "fetch(", "XMLHttpRequest", "import("}) {
    EXPECT_FALSE(holds(page, part)) << part;
  }
  EXPECT_FALSE(holds(page, "href=\"http"));
}

TEST(MapPage, ShowsForeignTextAsTextOnly) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  const std::string attack = "</script><img src=x>&amp;";
  made.parts.lanes[0].name = made.parts.roads[0].name = attack;
  made.parts.lanes[0].attributes = {{attack, attack}};
  const std::string page = write_map_page(made.build(), {.title = attack});
  EXPECT_FALSE(holds(page, "<img"));
}

TEST(MapPage, SaysWhyItHasNoLongitudesAndLatitudes) {
  std::vector<std::string> notes;
  const RoadMap road_map = tests::straight_two_lane_road().build();
  const std::string page = write_map_page(road_map, {.crs = "no such system", .notes = &notes});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("without longitude and latitude: ")) << notes[0];
  EXPECT_TRUE(holds(page, "\"lonLat\":null"));
}

TEST(MapPage, TakesAMapOfNothing) {
  EXPECT_TRUE(holds(write_map_page(RoadMap(RoadMapParts{})), "\"count\":0"));
}

// A file that QGIS reads has one polygon a lane; the page three lines, and all that is known.
void expect_small(const std::filesystem::path& file) {
  const RoadMap road_map = load_map(file);
  const Format& flatgeobuf = format_to_write("lanes.fgb");
  const std::size_t lanes = flatgeobuf.write(road_map, {}).size();
  EXPECT_LE(write_map_page(road_map).size(), lanes + lanes / 2) << file;
}

TEST(MapPage, IsSmallBesideTheFlatGeobufOfItsLanes) {
  expect_small(tests::data_folder() / "town.xodr");
}

TEST(MapPage, IsSmallBesideTheFlatGeobufOfTheLanesOfRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_small(folder / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr");
  expect_small(folder / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm");
}

}  // namespace
}  // namespace roadbed::map
