#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <memory>
#include <random>
#include <sstream>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map {
namespace {

/// Points at random distances around sensors on both sides of the origin; some nearer than a cell.
std::vector<PointCloud> random_scans(std::mt19937& random, int scans, int points) {
  std::normal_distribution<float> spread(0.0f, 6.0f);
  std::uniform_real_distribution<double> place(-9.0, 9.0);
  std::vector<PointCloud> clouds;
  for (int i = 0; i < scans; ++i) {
    PointCloud cloud;
    // A float, as OctoMap's own interface takes no double.
    const Eigen::Vector3f sensor =
        Eigen::Vector3d(place(random), place(random), 0.2 * place(random)).cast<float>();
    cloud.sensor_in_source = sensor.cast<double>();
    for (int k = 0; k < points; ++k) {
      const float scale = k % 10 == 0 ? 0.02f : 1.0f;
      const Eigen::Vector3f way(spread(random), spread(random), 0.3f * spread(random));
      cloud.points.push_back(sensor + scale * way);
    }
    clouds.push_back(std::move(cloud));
  }
  return clouds;
}

octomap::point3d octomap_point(const Eigen::Vector3f& point) {
  return {point.x(), point.y(), point.z()};
}

void insert(octomap::OcTree& tree, const PointCloud& cloud, double range_m) {
  octomap::Pointcloud points;
  for (const Eigen::Vector3f& point : cloud.points) points.push_back(octomap_point(point));
  tree.insertPointCloud(points, octomap_point(cloud.sensor_in_source->cast<float>()), range_m,
                        false, true);
}

std::unique_ptr<octomap::OcTree> read_with_octomap(const std::string& ot) {
  std::istringstream stream(ot);
  return std::unique_ptr<octomap::OcTree>(
      dynamic_cast<octomap::OcTree*>(octomap::AbstractOcTree::read(stream)));
}

void expect_equal_nodes(octomap::OcTree& a, octomap::OcTree& b) {
  ASSERT_EQ(a.size(), b.size());
  auto in_b = b.begin_tree();
  for (auto in_a = a.begin_tree(); in_a != a.end_tree(); ++in_a, ++in_b) {
    ASSERT_EQ(in_a.getKey(), in_b.getKey());
    ASSERT_EQ(in_a.getDepth(), in_b.getDepth());
    ASSERT_EQ(in_a->getLogOdds(), in_b->getLogOdds());
  }
}

TEST(OctreeBuild, WithoutStickyHitsTheTreeIsThatOfInsertPointCloudNodeForNode) {
  std::mt19937 random(20261122);
  for (int round = 0; round < 12; ++round) {
    const double resolution_m = round % 3 == 0 ? 0.1 : round % 3 == 1 ? 0.2 : 0.37;
    const double range_m = round % 2 == 0 ? -1.0 : 5.0;
    const auto clouds = random_scans(random, 1 + round, 300);
    octomap::OcTree theirs(resolution_m);
    for (const PointCloud& cloud : clouds) insert(theirs, cloud, range_m);
    OccupancyOptions options{.resolution_m = resolution_m, .sticky_hits = false};
    if (range_m > 0.0) options.carve_range_m = range_m;
    const OccupancyMap ours = OccupancyMap::build(clouds, options);
    const auto tree = read_with_octomap(ours.to_ot());
    ASSERT_TRUE(tree);
    expect_equal_nodes(*tree, theirs);

    // And so is the file of free and occupied cells.
    theirs.toMaxLikelihood();
    theirs.prune();
    std::ostringstream binary;
    theirs.writeBinaryData(binary);
    const auto file = OccupancyMap::build_bt(clouds, options);
    EXPECT_EQ(file.nodes, theirs.size());
    EXPECT_TRUE(file.bytes.ends_with("\ndata\n" + binary.str()));
    EXPECT_EQ(file.bytes, ours.to_bt());
  }
}

/// Sensors and points on corners and in middles of cells, so that rays cross several borders at
/// once, and end on borders where they are cut at a whole number of cells.
std::vector<PointCloud> scans_on_lattice(std::mt19937& random, int scans, int points,
                                         double resolution_m) {
  std::uniform_int_distribution<int> sensor_place(-20, 20), point_place(-90, 90);
  // In float all along: OctoMap takes no sensor that is not.
  const auto on_lattice = [&](std::uniform_int_distribution<int>& place) {
    Eigen::Vector3f at;
    for (float& value : at) value = static_cast<float>(place(random));
    return Eigen::Vector3f(static_cast<float>(0.5 * resolution_m) * at);
  };
  std::vector<PointCloud> clouds;
  for (int i = 0; i < scans; ++i) {
    PointCloud cloud;
    const Eigen::Vector3f sensor = on_lattice(sensor_place);
    cloud.sensor_in_source = sensor.cast<double>();
    for (int k = 0; k < points; ++k) {
      Eigen::Vector3f way = on_lattice(point_place);
      if (k % 3 == 0) way.y() = way.x();
      if (k % 5 == 0) way.z() = -way.x();
      if (k % 7 == 0) way.x() = 0.0f;
      cloud.points.push_back(sensor + way);
    }
    clouds.push_back(std::move(cloud));
  }
  return clouds;
}

TEST(OctreeBuild, RaysThatCrossSeveralBordersAtOnceGoAsInOctoMap) {
  std::mt19937 random(20261122);
  for (int round = 0; round < 12; ++round) {
    const double resolution_m = round % 3 == 0 ? 0.1 : round % 3 == 1 ? 0.25 : 0.3;
    const double range_m = round % 2 == 0 ? -1.0 : 10.0 * resolution_m;
    const auto clouds = scans_on_lattice(random, 3, 200, resolution_m);
    octomap::OcTree theirs(resolution_m);
    for (const PointCloud& cloud : clouds) insert(theirs, cloud, range_m);
    OccupancyOptions options{.resolution_m = resolution_m, .sticky_hits = false};
    if (range_m > 0.0) options.carve_range_m = range_m;
    const auto tree = read_with_octomap(OccupancyMap::build(clouds, options).to_ot());
    ASSERT_TRUE(tree);
    expect_equal_nodes(*tree, theirs);
  }
}

/// Free cells first, then hits, each by itself, as the law of sticky hits says it.
octomap::OcTree sticky_tree(const std::vector<PointCloud>& clouds, double resolution_m) {
  octomap::OcTree tree(resolution_m);
  octomap::KeyRay ray;
  std::vector<octomap::OcTreeKey> hits;
  for (const PointCloud& cloud : clouds) {
    const octomap::point3d sensor = octomap_point(cloud.sensor_in_source->cast<float>());
    for (const Eigen::Vector3f& point : cloud.points) {
      hits.push_back(tree.coordToKey(octomap_point(point)));
      tree.computeRayKeys(sensor, tree.keyToCoord(hits.back()), ray);
      for (const octomap::OcTreeKey& key : ray) {
        tree.setNodeValue(key, tree.getClampingThresMinLog(), true);
      }
    }
  }
  for (const octomap::OcTreeKey& key : hits) {
    tree.setNodeValue(key, tree.getClampingThresMaxLog(), true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

TEST(OctreeBuild, WithStickyHitsEveryCellIsWhatItsRaysAndPointsSay) {
  std::mt19937 random(7);
  for (const double resolution_m : {0.1, 0.25, 1.3}) {
    const auto clouds = random_scans(random, 4, 800);
    octomap::OcTree expected = sticky_tree(clouds, resolution_m);
    std::ostringstream binary;
    expected.writeBinaryData(binary);
    const auto file = OccupancyMap::build_bt(clouds, {.resolution_m = resolution_m});
    EXPECT_EQ(file.nodes, expected.size());
    EXPECT_TRUE(file.bytes.ends_with("\ndata\n" + binary.str()));
    const OccupancyMap ours = OccupancyMap::build(clouds, {.resolution_m = resolution_m});
    EXPECT_EQ(ours.to_bt(), file.bytes);
    EXPECT_EQ(ours.node_count(), file.nodes);
    const auto tree = read_with_octomap(ours.to_ot());
    ASSERT_TRUE(tree);
    expect_equal_nodes(*tree, expected);
  }
}

TEST(OctreeBuild, WhatMeasuredNothingIsAnEmptyFileThatIsReadAsOne) {
  PointCloud cloud;
  cloud.sensor_in_source = Eigen::Vector3d(0.0, 0.0, 0.0);
  cloud.points.emplace_back(1.0f, 0.0f, 0.0f);  // beyond the range, which lies in one cell
  const OccupancyOptions options{.carve_range_m = 0.01, .sticky_hits = false};
  const OccupancyMap ours = OccupancyMap::build(std::vector{cloud}, options);
  EXPECT_TRUE(ours.cells().empty());
  const auto file = OccupancyMap::build_bt(std::vector{cloud}, options);
  EXPECT_EQ(file.nodes, 0u);
  EXPECT_EQ(file.bytes, ours.to_bt());
  for (const std::string& bytes : {file.bytes, ours.to_ot()}) {
    EXPECT_TRUE(OccupancyMap::parse(bytes, "empty").cells().empty());
  }
}

/// Points around a sensor, so far apart that their rays share few cells.
PointCloud scattered(std::mt19937& random, int points) {
  std::normal_distribution<float> spread(0.0f, 1.0f);
  PointCloud cloud;
  cloud.sensor_in_source = Eigen::Vector3d(0.25, -0.125, 0.5);
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3f way(spread(random), spread(random), spread(random));
    cloud.points.push_back(50.0f * way.normalized());
  }
  return cloud;
}

TEST(OctreeBuild, RaysFarApartAreThoseOfOctoMapThoughMemoryIsForFewAtATime) {
  std::mt19937 random(20261122);
  const PointCloud cloud = scattered(random, 200);
  octomap::OcTree theirs(0.05);
  insert(theirs, cloud, -1.0);
  theirs.toMaxLikelihood();
  theirs.prune();
  std::ostringstream binary;
  theirs.writeBinaryData(binary);
  const auto file =
      OccupancyMap::build_bt(std::vector{cloud}, {.resolution_m = 0.05, .sticky_hits = false});
  EXPECT_EQ(file.nodes, theirs.size());
  EXPECT_TRUE(file.bytes.ends_with("\ndata\n" + binary.str()));
}

TEST(OctreeBuild, RaysFarApartAreNotRefusedForWhatTheyTakeOnTheWay) {
  std::mt19937 random(20261122);
  const PointCloud cloud = scattered(random, 1500);
  EXPECT_NO_THROW(OccupancyMap::build_bt(std::vector{cloud}, {.resolution_m = 0.05}));
}

TEST(OctreeBuild, PointsInMorePlacesThanMemoryIsForAreRefused) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-300.0f, 300.0f);
  for (const bool sticky : {true, false}) {
    PointCloud cloud;
    for (int i = 0; i < 60'000; ++i) {
      cloud.points.emplace_back(place(random), place(random), place(random));
    }
    EXPECT_THROW(
        OccupancyMap::build_bt(std::vector{cloud}, {.resolution_m = 0.01, .sticky_hits = sticky}),
        InputError);
    EXPECT_NO_THROW(
        OccupancyMap::build_bt(std::vector{cloud}, {.resolution_m = 0.5, .sticky_hits = true}));
  }
}

TEST(OctreeBuild, JoinsASolidCubeToOneLeafOnEveryLevel) {
  for (const int side : {2, 4, 8, 16, 32, 64}) {
    PointCloud cloud;
    for (int x = 0; x < side; ++x) {
      for (int y = 0; y < side; ++y) {
        for (int z = 0; z < side; ++z) {
          cloud.points.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                    static_cast<float>(z) + 0.5f);
        }
      }
    }
    const OccupancyMap cube = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 1.0});
    ASSERT_EQ(cube.cells().size(), 1u);
    EXPECT_EQ(cube.cells().front().size_m, side);
    // From the root, of 65536 cells, a node on each level down to the leaf.
    EXPECT_EQ(cube.node_count(), 17u - static_cast<std::size_t>(std::log2(side)));
  }
}

}  // namespace
}  // namespace roadbed::map
