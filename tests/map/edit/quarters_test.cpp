// A map that is cut in four and put together again is the whole.

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

Region box(const Vector2d& a, const Vector2d& b) { return Region({geometry::box_ring(a, b)}); }

std::string quarters_together(const std::string& bytes, const std::string& name,
                              const Vector2d& at) {
  constexpr double far_m = 1e7;
  std::vector<MergeInput> parts;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const Vector2d corner = at + far_m * Vector2d(x, y);
      Edited part = clip(bytes, name, box(at.cwiseMin(corner), at.cwiseMax(corner)));
      if (part.bytes.empty()) continue;
      EXPECT_NO_THROW(parse_map(part.bytes, "part of " + name));
      parts.push_back({std::move(part.bytes), "part of " + name});
    }
  }
  Merged merged = merge(std::move(parts));
  EXPECT_TRUE(merged.renamed.empty())
      << merged.renamed.front().kind << " " << merged.renamed.front().from;
  return std::move(merged.bytes);
}

void expect_equal(const RoadMap& whole, const RoadMap& again, const Vector2d& at) {
  const auto changes = diff(whole, again);
  EXPECT_TRUE(changes.empty()) << "cut at " << at.transpose() << ": " << changes.size() << ", "
                               << changes.front().theme << " " << changes.front().element << " "
                               << to_string(changes.front().kind);
}

// Cut at middles of random lanes.
void expect_whole_again(const std::filesystem::path& file, int times) {
  const std::string bytes = read_file(file), name = file.filename().string();
  const RoadMap whole = parse_map(bytes, name);
  std::mt19937 random(21);
  for (int i = 0; i < times; ++i) {
    const Lane& lane = whole.lanes()[random() % whole.lanes().size()];
    const Vector2d at = whole.to_source(lane.centre.in_map.at(0.37 * lane.length_m()));
    expect_equal(whole, parse_map(quarters_together(bytes, name, at), name), at);
  }
}

// Costs of routes between random lanes; those without a route cost nothing.
std::vector<double> costs(const RoadMap& road_map, int count) {
  std::mt19937 random(22);
  std::vector<std::string> names;
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) names.push_back(lane.name);
  }
  std::sort(names.begin(), names.end());
  planning::Router router(road_map);
  std::vector<double> found;
  for (int i = 0; i < count; ++i) {
    const auto place = [&] {
      const LaneId lane = *road_map.find_lane(names[random() % names.size()]);
      return planning::RoutePlace{{lane, 0.5 * road_map.lane(lane).length_m(), 0.0},
                                  planning::Sense::either};
    };
    const auto from = place(), to = place();
    const planning::RouteAnswer answer = router.find(from, to);
    found.push_back(answer.route ? answer.route->cost_s : -1.0);
  }
  return found;
}

void expect_same_routes(const std::filesystem::path& file, const Vector2d& at) {
  const std::string bytes = read_file(file), name = file.filename().string();
  const std::string again = quarters_together(bytes, name, at);
  const auto before = costs(parse_map(bytes, name), 300), now = costs(parse_map(again, name), 300);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], now[i], 1e-9) << i;
}

TEST(Quarters, OfMadeMapsAreTheWholeAgain) {
  for (const char* name :
       {"town.xodr", "country.xodr", "ramp.xodr", "crossing.osm", "junction.xml"}) {
    expect_whole_again(tests::data_folder() / name, 4);
  }
}

TEST(Quarters, OfTown04AreTheWholeAgain) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const auto town = real / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr";
  expect_whole_again(town, 3);
  expect_same_routes(town, {0.0, 0.0});
}

TEST(Quarters, OfMappingExampleAreTheWholeAgain) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const auto example =
      real / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm";
  expect_whole_again(example, 5);
  expect_same_routes(example, {457845.6, 5428186.7});
}

TEST(Quarters, OfOtherRealMapsAreTheWholeAgain) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  for (const char* name : {"opendrive/BerkeleyLearnVerify+Scenic/Town01.xodr",
                           "opendrive/BerkeleyLearnVerify+Scenic/Town10HD.xodr",
                           "opendrive/esmini+esmini/soderleden.xodr",
                           "opendrive/maliput+maliput_malidrive/cloverleaf.xodr",
                           "opendrive/maliput+maliput_malidrive/Figure8.xodr",
                           "lanelet2/autowarefoundation+autoware_core/2km_test.osm",
                           "lanelet2/autowarefoundation+autoware_core/intersection.osm"}) {
    expect_whole_again(real / name, 2);
  }
}

TEST(Quarters, OfScenariosAreTheWholeAgain) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(real / "commonroad")) {
    if (entry.path().extension() != ".xml") continue;
    SCOPED_TRACE(entry.path().filename());
    expect_whole_again(entry.path(), 2);
    ++files;
  }
  EXPECT_GE(files, 30u);
}

// Nine parts of a map that is cut again and again.
TEST(Quarters, OfQuartersAreTheWholeAgain) {
  for (const char* name : {"town.xodr", "crossing.osm", "junction.xml"}) {
    const std::string bytes = read_file(tests::data_folder() / name);
    const RoadMap whole = parse_map(bytes, name);
    const Lane& lane = whole.lanes()[whole.lanes().size() / 2];
    const auto at = [&](double part) {
      return whole.to_source(lane.centre.in_map.at(part * lane.length_m()));
    };
    std::vector<MergeInput> parts;
    for (const double x : {-1.0, 1.0}) {
      const Vector2d a = at(0.3), far(x * 1e7, 1e7);
      const Vector2d corner = a + far, other(a.x(), a.y() - 2e7);
      const Edited half = clip(bytes, name, box(corner.cwiseMin(other), corner.cwiseMax(other)));
      for (const double y : {-1.0, 1.0}) {
        const Vector2d b = at(0.7) + Vector2d(-2e7, 0.0), c = at(0.7) + Vector2d(2e7, y * 1e7);
        if (half.bytes.empty()) continue;
        Edited quarter = clip(half.bytes, name, box(b.cwiseMin(c), b.cwiseMax(c)));
        if (!quarter.bytes.empty()) parts.push_back({std::move(quarter.bytes), name});
      }
    }
    EXPECT_GE(parts.size(), 3u);
    expect_equal(whole, parse_map(merge(std::move(parts)).bytes, name), at(0.5));
  }
}

}  // namespace
}  // namespace roadbed::map
