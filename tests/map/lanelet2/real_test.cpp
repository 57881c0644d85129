// Real maps, and the project's own one: what was counted once with the `lanelet2` package of PyPI
// (tests/peers/compare_lanelet2.py compares lane by lane), and every real file read or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

struct Golden {
  const char* file;
  std::size_t lanes, drivable, regulations, areas;
  std::size_t followings;    // of lanes that a car may use, by the routing graph for vehicles
  double drivable_length_m;  // of all centrelines of lanes that a car may use
  const char* crs;
};

Golden counted(const char* file, const RoadMap& road_map) {
  Golden found{file,
               road_map.lanes().size(),
               0,
               road_map.regulations().size(),
               road_map.areas().size(),
               0,
               0.0,
               ""};
  for (const Lane& lane : road_map.lanes()) {
    if (!lane.participants.has(Participant::car)) continue;
    ++found.drivable;
    found.drivable_length_m += lane.length_m();
    for (const LaneId next : road_map.graph().of(lane.id).successors) {
      if (road_map.lane(next).participants.has(Participant::car)) ++found.followings;
    }
  }
  return found;
}

void expect_golden(const Golden& golden, const RoadMap& road_map) {
  const Golden found = counted(golden.file, road_map);
  EXPECT_EQ(found.lanes, golden.lanes);
  EXPECT_EQ(found.drivable, golden.drivable);
  EXPECT_EQ(found.regulations, golden.regulations);
  EXPECT_EQ(found.areas, golden.areas);
  EXPECT_EQ(found.followings, golden.followings);
  // A few centrelines have other vertices there, as rounding decides: one in a thousand metres.
  EXPECT_NEAR(found.drivable_length_m, golden.drivable_length_m, 1e-3 * golden.drivable_length_m);
  EXPECT_EQ(road_map.crs(), golden.crs);
}

const Golden kGolden[] = {
    {"fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm", 371, 328, 9, 76, 313,
     4618.334411, "EPSG:32632"},
    {"autowarefoundation+autoware_core/2km_test.osm", 160, 160, 0, 0, 158, 4000.000000, ""},
    {"autowarefoundation+autoware_core/intersection.osm", 161, 146, 25, 0, 146, 13256.272293,
     "+proj=tmerc +lat_0=0 +lon_0=141 +k=0.9996 +x_0=200000 +y_0=-3900000 +datum=WGS84 +units=m "
     "+no_defs"},
    {"autowarefoundation+autoware_core/road_shoulder.osm", 371, 276, 3, 0, 273, 13410.179788,
     "+proj=tmerc +lat_0=0 +lon_0=141 +k=0.9996 +x_0=200000 +y_0=-3900000 +datum=WGS84 +units=m "
     "+no_defs"},
    {"autowarefoundation+autoware_core/vm_03_left_hand.osm", 77, 64, 25, 0, 50, 2480.137647,
     "+proj=tmerc +lat_0=0 +lon_0=141 +k=0.9996 +x_0=200000 +y_0=-3900000 +datum=WGS84 +units=m "
     "+no_defs"},
    {"tier4+autoware_lanelet2_map_validator/intersection/basic_intersection_area.osm", 20, 20, 0, 0,
     24, 430.161615,
     "+proj=tmerc +lat_0=0 +lon_0=141 +k=0.9996 +x_0=100000 +y_0=-3900000 +datum=WGS84 +units=m "
     "+no_defs"},
    {"tier4+autoware_lanelet2_map_validator/intersection/right_of_way_without_traffic_light.osm",
     53, 45, 32, 0, 51, 733.762357,
     "+proj=tmerc +lat_0=0 +lon_0=141 +k=0.9996 +x_0=100000 +y_0=-3900000 +datum=WGS84 +units=m "
     "+no_defs"}};

const Golden kCrossing = {"crossing.osm",
                          24,
                          22,
                          5,
                          1,
                          24,
                          980.350801,
                          "+proj=tmerc +lat_0=0 +lon_0=9 +k=0.9996 +x_0=100000 +y_0=-5400000 "
                          "+datum=WGS84 +units=m +no_defs"};

class RealLanelet2 : public testing::TestWithParam<Golden> {};

TEST_P(RealLanelet2, HasWhatTheLanelet2PackageFoundInIt) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  expect_golden(GetParam(), load_map(real / "lanelet2" / GetParam().file));
}

INSTANTIATE_TEST_SUITE_P(Files, RealLanelet2, testing::ValuesIn(kGolden), [](const auto& test) {
  std::string name = std::filesystem::path(test.param.file).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); },
      '_');
  return name;
});

TEST(Lanelet2Crossing, HasWhatTheLanelet2PackageFoundInIt) {
  expect_golden(kCrossing, load_map(tests::data_folder() / "crossing.osm"));
}

TEST(Lanelet2Crossing, HasItsRulesLightsAndSurroundings) {
  const RoadMap road_map = load_map(tests::data_folder() / "crossing.osm");
  EXPECT_EQ(road_map.signals().size(), 5u);  // four lights and a sign
  EXPECT_EQ(road_map.stop_lines().size(), 4u);
  for (const StopLine& line : road_map.stop_lines()) {
    EXPECT_FALSE(line.lanes.empty());
    EXPECT_EQ(line.signals.size(), 1u);
  }
  ASSERT_EQ(road_map.areas().size(), 1u);
  EXPECT_NEAR(geometry::area_m2(road_map.areas()[0].in_map.at(0)), 30.0 * 20.0 - 10.0 * 6.0, 1e-6);
  ASSERT_EQ(road_map.unused().size(), 1u);
  EXPECT_EQ(road_map.unused()[0].name, "way/fence");
  const auto& lanes = road_map.lanes();
  const auto limited = [&](double limit_mps) {
    return std::count_if(lanes.begin(), lanes.end(), [&](const Lane& lane) {
      const auto limit = lane.speed_limit_at_mps(0.0);
      return limit && std::abs(*limit - limit_mps) < 1e-9;
    });
  };
  EXPECT_EQ(limited(60.0 / 3.6), 4);
  EXPECT_EQ(limited(30.0 * 0.44704), 2);
  EXPECT_EQ(limited(30.0 / 3.6), 14);  // twelve movements, and the two lanes of the sign
  EXPECT_NEAR(lanes.front().centre.z_m.back() - lanes.front().centre.z_m.front(),
              0.01 * (lanes.front().centre.in_map.points().back() -
                      lanes.front().centre.in_map.points().front())
                         .x(),
              1e-3);
}

TEST(Lanelet2Files, AreAllReadThoseWithSingleDefectsToo) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(real / "lanelet2")) {
    if (entry.path().extension() != ".osm") continue;
    ++files;
    try {
      const RoadMap road_map = load_map(entry.path());
      EXPECT_FALSE(road_map.lanes().empty()) << entry.path();
      EXPECT_FALSE(road_map.crs().empty() &&
                   entry.path().filename() != "2km_test.osm")  // its MGRS code is none
          << entry.path();
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GE(files, 60);
}

}  // namespace
}  // namespace roadbed::map
