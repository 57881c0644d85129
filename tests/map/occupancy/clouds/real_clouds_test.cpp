#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

struct RealCloud {
  const char* file;
  std::size_t points;
  Eigen::Vector3d least, most;
  double within;
  const char* crs;
  LengthUnit unit;
};

// Counts from the headers, bounds from the LAS headers and by awk and numpy from the others.
const RealCloud kRealClouds[] = {
    {"PDAL+PDAL/autzen-thin.las",
     10653,
     {635589.01, 848886.45, 406.59},
     {638994.75, 853535.43, 593.73},
     1e-3,
     "",
     LengthUnit::unknown},
    {"PDAL+PDAL/epsg_4326.las",
     5380,
     {-94.6834654, 31.0367341, 39.0810002},
     {-94.6606311, 31.0473291, 78.1190002},
     1e-5,
     "EPSG:4326",
     LengthUnit::degree},
    {"PDAL+PDAL/sample_nc.las",
     14408,
     {674521.92, 1206740.08, 627.53},
     {674605.32, 1206814.96, 656.23},
     1e-3,
     "",
     LengthUnit::unknown},
    {"hobuinc+laz-perf/point-color-time.las",
     1065,
     {493994.87, 4877429.62, 123.93},
     {494993.68, 4878817.02, 178.73},
     1e-3,
     "EPSG:26910",
     LengthUnit::metre},
    {"libLAS+libLAS/1.0_0.las",
     1,
     {470692.44, 4602888.90, 16.0},
     {470692.44, 4602888.90, 16.0},
     1e-3,
     "EPSG:26915",
     LengthUnit::metre},
    {"libLAS+libLAS/1.2_3.las",
     1,
     {470692.44, 4602888.90, 16.0},
     {470692.44, 4602888.90, 16.0},
     1e-3,
     "EPSG:26915",
     LengthUnit::metre},
    {"libLAS+libLAS/bad_points_1.1.las", 1, {0, 0, 0}, {0, 0, 0}, 1e-12, "", LengthUnit::unknown},
    {"PDAL+PDAL/autzen-utm.pcd",
     1065,
     {493994.87, 4877429.62, 123.93},
     {494993.68, 4878817.02, 178.73},
     1e-3,
     "",
     LengthUnit::unknown},
    {"autowarefoundation+autoware.universe/test.pcd",
     65536,
     {-243.81808, -95.928505, -2.1303055},
     {130.49535, 91.214272, 11.136353},
     1e-4,
     "",
     LengthUnit::unknown},
    {"facontidavide+Bonxai/apple.pcd",
     3161,
     {-0.046643924, 0.69300002, -0.057439197},
     {0.027309919, 0.76700002, 0.028467119},
     1e-7,
     "",
     LengthUnit::unknown},
    {"libLAS+libLAS/1.2-with-color.las",
     1065,
     {635619.85, 848899.70, 406.59},
     {638982.55, 853535.43, 586.38},
     1e-3,
     "",
     LengthUnit::unknown},
};

class RealClouds : public testing::TestWithParam<RealCloud> {};

TEST_P(RealClouds, HaveTheirCountsBoundsAndFrame) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const RealCloud& expected = GetParam();
  const PointCloud cloud = read_point_cloud(folder / "occupancy" / expected.file);
  EXPECT_EQ(cloud.points.size(), expected.points);
  const Box3 box = bounds(cloud);
  EXPECT_LT((box.min_in_source - expected.least).cwiseAbs().maxCoeff(), expected.within);
  EXPECT_LT((box.max_in_source - expected.most).cwiseAbs().maxCoeff(), expected.within);
  EXPECT_EQ(cloud.crs, expected.crs);
  EXPECT_EQ(cloud.unit, expected.unit);
}

INSTANTIATE_TEST_SUITE_P(Files, RealClouds, testing::ValuesIn(kRealClouds));

TEST(RealOctrees, HaveTheNodesOfTheirHeaders) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto geb079 = OccupancyMap::load(folder / "occupancy/OctoMap+octomap/geb079.bt");
  EXPECT_EQ(geb079.node_count(), 532566u);
  EXPECT_EQ(geb079.resolution_m(), 0.08);
  const auto catec = OccupancyMap::load(folder / "occupancy/robotics-upo+dll/catec.bt");
  EXPECT_EQ(catec.node_count(), 2867081u);
  EXPECT_EQ(catec.resolution_m(), 0.05);
}

TEST(RealFiles, ThatAreNoCloudsAreRefusedWithAReason) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto refusal = [&](const char* file) -> std::string {
    return tests::refusal_of([&] { read_point_cloud(folder / "occupancy" / file); });
  };
  EXPECT_THAT(refusal("OctoMap+octomap/spherical_scan.graph"),
              testing::HasSubstr("no known point cloud format"));
}

}  // namespace
}  // namespace roadbed::map
