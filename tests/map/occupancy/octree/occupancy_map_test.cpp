#include "roadbed/map/occupancy/octree/occupancy_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

PointCloud cloud_of(std::vector<Eigen::Vector3f> points) {
  PointCloud cloud;
  cloud.name = "test.pcd";
  cloud.points = std::move(points);
  return cloud;
}

std::string refusal(const std::string& bytes) {
  return tests::refusal_of([&] { OccupancyMap::parse(bytes, "a.bt"); });
}

std::string bt(const std::string& size, const std::string& data) {
  return "# Octomap OcTree binary file\nid OcTree\nsize " + size + "\nres 0.1\ndata\n" + data;
}

std::string ot(const std::string& size, const std::string& data) {
  return "# Octomap OcTree file\n# comment\nid OcTree\nsize " + size + "\nres 0.1\ndata\n" + data;
}

std::string node(float log_odds, std::uint8_t children) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &log_odds, 4);
  return bytes + static_cast<char>(children);
}

TEST(OccupancyMap, KeepsEveryMeasuredHitWhateverRaysCarveLater) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<float> wide(-10.0f, 10.0f), flat(-0.4f, 0.4f);
  std::vector<PointCloud> clouds;
  for (int scan = 0; scan < 5; ++scan) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 500; ++i) points.emplace_back(wide(random), wide(random), flat(random));
    clouds.push_back(cloud_of(points));
    clouds.back().sensor_in_source = Eigen::Vector3d(0.3 * scan, 0.2, 0.1);
  }
  const OccupancyMap occupancy = OccupancyMap::build(clouds, {.resolution_m = 0.2});
  for (const PointCloud& cloud : clouds) {
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      EXPECT_EQ(occupancy.at(cloud.in_source(i)), CellState::occupied);
    }
  }
}

TEST(OccupancyMap, CarvesFreeSpaceUpToTheHitAndLeavesWhatIsBehindUnknown) {
  PointCloud cloud = cloud_of({{5.05f, 0.05f, 0.05f}});
  cloud.sensor_in_source = Eigen::Vector3d(0.05, 0.05, 0.05);
  const std::vector<PointCloud> clouds{cloud};
  const OccupancyMap whole = OccupancyMap::build(clouds, {.resolution_m = 0.1});
  EXPECT_EQ(whole.at({0.05, 0.05, 0.05}), CellState::free);
  EXPECT_EQ(whole.at({4.95, 0.05, 0.05}), CellState::free);
  EXPECT_EQ(whole.at({5.05, 0.05, 0.05}), CellState::occupied);
  EXPECT_EQ(whole.at({5.15, 0.05, 0.05}), CellState::unknown);
  EXPECT_EQ(whole.at({1.0, 0.25, 0.05}), CellState::unknown);
  EXPECT_EQ(whole.at({1e9, 0, 0}), CellState::unknown);
  const OccupancyMap near =
      OccupancyMap::build(clouds, {.resolution_m = 0.1, .carve_range_m = 2.0});
  EXPECT_EQ(near.at({1.95, 0.05, 0.05}), CellState::free);
  EXPECT_EQ(near.at({2.25, 0.05, 0.05}), CellState::unknown);
  EXPECT_EQ(near.at({5.05, 0.05, 0.05}), CellState::occupied);
}

TEST(OccupancyMap, WithoutASensorOnlyMarksHits) {
  const std::vector<PointCloud> clouds{cloud_of({{1, 2, 3}, {1, 2, 3}, {-4, 5, 6}})};
  const OccupancyMap occupancy = OccupancyMap::build(clouds, {.resolution_m = 0.5});
  const auto cells = occupancy.cells();
  ASSERT_EQ(cells.size(), 2u);
  for (const OccupancyCell& cell : cells) EXPECT_EQ(cell.state, CellState::occupied);
}

TEST(OccupancyMap, KeepsAnOriginFarAwayAndItsFrameThroughAFile) {
  PointCloud cloud = cloud_of({{0.5f, 0.25f, -1.0f}, {40.0f, 3.0f, 2.0f}});
  cloud.origin_in_source = {443210.0, 5400000.0, 115.0};
  cloud.crs = "EPSG:25832\nforged";
  cloud.sensor_in_source = Eigen::Vector3d(443220.0, 5400001.0, 116.0);
  const OccupancyMap built = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.25});
  const std::string bytes = built.to_bt();
  const OccupancyMap read = OccupancyMap::parse(bytes, "a.bt");
  EXPECT_EQ(read.to_bt(), bytes);
  EXPECT_EQ(read.crs(), "EPSG:25832 forged");
  EXPECT_EQ(read.origin_in_source(), built.origin_in_source());
  EXPECT_EQ(read.node_count(), built.node_count());
  EXPECT_EQ(read.at(cloud.in_source(0)), CellState::occupied);
  EXPECT_EQ(read.at(cloud.in_source(1)), CellState::occupied);
  const auto before = built.cells(), after = read.cells();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].centre_in_source, after[i].centre_in_source);
    EXPECT_EQ(before[i].state, after[i].state);
  }
}

TEST(OccupancyMap, RefusesWhatItsKeysCannotHold) {
  const auto build = [](std::vector<PointCloud> clouds, double resolution_m) {
    return OccupancyMap::build(clouds, {.resolution_m = resolution_m});
  };
  try {
    build({cloud_of({{0, 0, 0}, {7000, 0, 0}})}, 0.1);
    FAIL() << "70000 cells do not fit";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("coarser resolution"));
  }
  EXPECT_NO_THROW(build({cloud_of({{0, 0, 0}, {6000, 0, 0}})}, 0.1));
  PointCloud far_sensor = cloud_of({{0, 0, 0}});
  far_sensor.sensor_in_source = Eigen::Vector3d(1e6, 0, 0);
  EXPECT_THROW(build({far_sensor}, 0.1), InputError);
  EXPECT_THROW(build({}, 0.1), std::invalid_argument);
  EXPECT_THROW(build({cloud_of({})}, 0.1), std::invalid_argument);
  EXPECT_THROW(build({cloud_of({{0, 0, 0}})}, 0.0), std::invalid_argument);
  PointCloud other_frame = cloud_of({{0, 0, 0}});
  other_frame.crs = "EPSG:1";
  EXPECT_THROW(build({cloud_of({{0, 0, 0}}), other_frame}, 0.1), InputError);
}

TEST(OctreeFile, ReadsASmallTreeOfEitherForm) {
  // Root with child 0 occupied and child 7 free.
  const OccupancyMap binary = OccupancyMap::parse(bt("3", std::string("\x02\x40", 2)), "a.bt");
  EXPECT_EQ(binary.node_count(), 3u);
  EXPECT_EQ(binary.at({-1, -1, -1}), CellState::occupied);
  EXPECT_EQ(binary.at({1, 1, 1}), CellState::free);
  EXPECT_EQ(binary.at({1, 1, -1}), CellState::unknown);
  const OccupancyMap full =
      OccupancyMap::parse(ot("3", node(0.5f, 0x81) + node(0.5f, 0) + node(-0.5f, 0)), "a.ot");
  EXPECT_EQ(full.at({-1, -1, -1}), CellState::occupied);
  EXPECT_EQ(full.at({1, 1, 1}), CellState::free);
  EXPECT_EQ(full.to_bt(), binary.to_bt().substr(0, full.to_bt().size()));
}

TEST(OctreeFile, RefusesBytesThatMakeOctomapRecurseWithoutBound) {
  EXPECT_THAT(refusal(bt("100", std::string(200'000, '\xff'))), HasSubstr("17 levels deep"));
  EXPECT_THAT(refusal(ot("100", std::string(200'000, '\xff'))), HasSubstr("not finite"));
  std::string deep;
  for (int i = 0; i < 20'000; ++i) deep += node(1.0f, 0x01);
  EXPECT_THAT(refusal(ot("20000", deep)), HasSubstr("17 levels deep"));
}

TEST(OctreeFile, RefusesCutLongAndMiscountedTrees) {
  const std::string tree = node(0.5f, 0x81) + node(0.5f, 0) + node(-0.5f, 0);
  EXPECT_THAT(refusal(ot("100", "")), HasSubstr("ends after 0 nodes"));
  EXPECT_THAT(refusal(ot("3", tree.substr(0, 12))), HasSubstr("ends after 2 nodes"));
  EXPECT_THAT(refusal(ot("4", tree)), HasSubstr("has 3 nodes"));
  EXPECT_THAT(refusal(ot("3", tree + "x")), HasSubstr("1 bytes are left"));
  EXPECT_THAT(refusal(bt("3", "\x02")), HasSubstr("ends after 1 nodes"));
  EXPECT_THAT(refusal(bt("4", std::string("\x02\x40", 2))), HasSubstr("has 3 nodes"));
  EXPECT_THAT(refusal(bt("1", std::string(2, '\0'))), HasSubstr("no child"));
  EXPECT_THAT(refusal(bt("0", "xx")), HasSubstr("2 bytes are left"));
  EXPECT_EQ(refusal(bt("0", "")), "accepted");
}

TEST(OctreeFile, RefusesHeadersThatSayNothingUsable) {
  EXPECT_THAT(refusal("nonsense"), HasSubstr("is not OctoMap's"));
  EXPECT_THAT(refusal("# Octomap OcTree binary file\nid OcTree\nsize 1\n"), HasSubstr("data line"));
  EXPECT_THAT(refusal(bt("many", "")), HasSubstr("\"many\""));
  for (const char* resolution : {"nan", "0", "-1", "1e-300", "inf", "x"}) {
    EXPECT_THAT(refusal("# Octomap OcTree binary file\nid OcTree\nsize 0\nres " +
                        std::string(resolution) + "\ndata\n"),
                HasSubstr("res"));
  }
  EXPECT_THAT(refusal("# Octomap OcTree file\nid ColorOcTree\nsize 0\nres 0.1\ndata\n"),
              HasSubstr("ColorOcTree"));
  EXPECT_THAT(refusal("# Octomap OcTree binary file\n# roadbed origin 1 2 nan X\nid OcTree\n"),
              HasSubstr("origin"));
}

}  // namespace
}  // namespace roadbed::map
