// Every real OpenDRIVE file against a table that tests/map/opendrive/golden.py made by an
// evaluation of its own: counts exactly, lengths and areas within what 1 mm of chord error makes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Json = nlohmann::json;

Json golden_table() {
  std::ifstream file(tests::tests_folder() / "map/opendrive/golden.json");
  return Json::parse(file);
}

// Between the borders, what folds over counted against the rest, as the table's evaluation does;
// the lane's polygon is what is left without folds.
double area_m2(const Lane& lane) {
  geometry::Ring ring = lane.right.in_map.points();
  ring.insert(ring.end(), lane.left.in_map.points().rbegin(), lane.left.in_map.points().rend());
  return std::abs(geometry::signed_area_m2(ring));
}

Json row_of(const RoadMap& road_map) {
  double driving_m = 0.0, lanes_m2 = 0.0;
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) driving_m += lane.length_m();
    lanes_m2 += area_m2(lane);
  }
  return {{"roads", road_map.roads().size()},
          {"lanes", road_map.lanes().size()},
          {"junctions", road_map.junctions().size()},
          {"controllers", road_map.controllers().size()},
          {"signals", road_map.signals().size()},
          {"objects", road_map.objects().size()},
          {"driving_m", driving_m},
          {"lanes_m2", lanes_m2}};
}

void expect_row(const RoadMap& road_map, const Json& golden, const std::string& name) {
  ASSERT_FALSE(golden.contains("refused")) << name << " was read";
  const Json row = row_of(road_map);
  for (const auto& [key, expected] : golden.items()) {
    const double tolerance = key == "driving_m"  ? 0.02 + 1e-5 * expected.get<double>()
                             : key == "lanes_m2" ? 0.2 + 3e-5 * expected.get<double>()
                                                 : 0.0;
    EXPECT_NEAR(row.at(key).get<double>(), expected.get<double>(), tolerance)
        << name << ": " << key;
  }
}

TEST(GoldenOpenDrive, EveryRealFileIsReadAsTheTableSaysOrRefusedForItsReason) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const Json table = golden_table();
  const std::filesystem::path folder = real / "opendrive";
  std::set<std::string> seen;
  for (const auto& [name, golden] : table.items()) {
    if (!std::filesystem::exists(folder / name)) continue;
    seen.insert(name);
    try {
      expect_row(load_map(folder / name), golden, name);
    } catch (const InputError& error) {
      ASSERT_TRUE(golden.contains("refused")) << error.what();
      EXPECT_NE(std::string(error.what()).find(golden.at("refused").get<std::string>()),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_EQ(seen.size(), table.size());
}

}  // namespace
}  // namespace roadbed::map
