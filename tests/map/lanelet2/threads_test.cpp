#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/lanelet2/read.h"

namespace roadbed::map {
namespace {

// Lanelets behind each other, more than are built at once; of some, things are missing.
std::string many_lanelets() {
  constexpr int kLanelets = 2500;
  std::string nodes, ways, relations;
  for (int i = 0; i <= kLanelets; ++i) {
    for (int side = 0; side < 2; ++side) {
      nodes += i % 700 == 3 ? fmt::format("<node id='{}'/>\n", 1 + 2 * i + side)
                            : fmt::format("<node id='{}' lat='{:.7f}' lon='{:.7f}'/>\n",
                                          1 + 2 * i + side, 49.0 + 1e-4 * i, 8.4 + 3e-5 * side);
      ways += fmt::format("<way id='{}'><nd ref='{}'/><nd ref='{}'/></way>\n",
                          10'001 + 2 * i + side, 1 + 2 * i + side, 3 + 2 * i + side);
    }
    relations += fmt::format(
        "<relation id='{}'><member type='way' ref='{}' role='left'/>"
        "<member type='way' ref='{}' role='right'/><tag k='type' v='lanelet'/></relation>\n",
        20'001 + i, 10'001 + 2 * i, i % 500 == 7 ? 1 : 10'002 + 2 * i);
  }
  return "<osm>\n" + nodes + ways + relations + "</osm>\n";
}

TEST(Lanelet2Threads, ReadTheSameMapForAnyNumber) {
  const std::string text = many_lanelets();
  const std::string one = write_compiled_map(RoadMap(lanelet2::read(text, "many.osm")));
  for (const int threads : {2, 5}) {
    const RoadMap road_map(lanelet2::read(text, "many.osm", threads));
    EXPECT_GT(road_map.lanes().size(), 2400u);
    EXPECT_GT(road_map.import_diagnostics().size(), 5u);
    EXPECT_EQ(write_compiled_map(road_map), one);
  }
}

}  // namespace
}  // namespace roadbed::map
