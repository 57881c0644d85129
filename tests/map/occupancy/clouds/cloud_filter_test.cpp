#include "roadbed/map/occupancy/clouds/cloud_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/tests/support/needs_pcl.h"

namespace roadbed::map {
namespace {

PointCloud wall_with_a_bird() {
  PointCloud cloud;
  cloud.origin_in_source = {443210.0, 5400000.0, 0.0};
  for (int y = 0; y < 40; ++y) {
    for (int z = 0; z < 20; ++z) {
      cloud.points.emplace_back(5.0f, 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z));
    }
  }
  cloud.points.emplace_back(60.0f, 60.0f, 60.0f);
  return cloud;
}

bool holds_the_bird(const PointCloud& cloud) {
  return std::any_of(cloud.points.begin(), cloud.points.end(),
                     [](const Eigen::Vector3f& point) { return point.x() > 50.0f; });
}

class CloudFilterTest : public tests::NeedsPcl {};

TEST_F(CloudFilterTest, TakesOutAPointFarFromItsNeighboursAndKeepsTheOrigin) {
  const PointCloud cloud = wall_with_a_bird();
  const PointCloud kept = filtered(cloud, {.outlier_neighbours = 8});
  EXPECT_FALSE(holds_the_bird(kept));
  EXPECT_GT(kept.points.size(), 780u);
  EXPECT_EQ(kept.origin_in_source, cloud.origin_in_source);
}

TEST_F(CloudFilterTest, ThinsToAPointPerCube) {
  const PointCloud kept = filtered(wall_with_a_bird(), {.voxel_m = 0.5});
  EXPECT_TRUE(holds_the_bird(kept));
  EXPECT_GE(kept.points.size(), 8u * 4u);
  EXPECT_LE(kept.points.size(), 9u * 5u + 1u);
}

// As sweeps whose log says where on the vehicle the lidars are.
// PCL would leave all points as they are, and say so on a line of its own.
TEST_F(CloudFilterTest, RefusesCubesThatAreMoreThanCanBeCounted) {
  PointCloud cloud;
  cloud.points = {{0, 0, 0}, {1000, 1000, 100}};
  EXPECT_EQ(filtered(cloud, {.voxel_m = 0.5}).points.size(), 2u);
  EXPECT_THROW(filtered(cloud, {.voxel_m = 0.01}), InputError);
}

TEST_F(CloudFilterTest, KeepsFromWhereEachPointWasMeasured) {
  PointCloud cloud = wall_with_a_bird();
  const auto sensor_of = [](const PointCloud& of, std::size_t point) {
    const auto after = std::ranges::upper_bound(of.scans, point, {}, &ScanStart::first);
    return std::prev(after)->sensor_in_source;
  };
  for (std::size_t first = 0; first < cloud.points.size(); first += 50) {
    const auto number = static_cast<double>(first);
    cloud.scans.push_back({first, Eigen::Vector3d(number, 0.0, 2.0)});
  }
  for (const CloudFilter& filter :
       {CloudFilter{.voxel_m = 0.5}, CloudFilter{.outlier_neighbours = 8}}) {
    const PointCloud kept = filtered(cloud, filter);
    ASSERT_LT(kept.points.size(), cloud.points.size());
    ASSERT_GT(kept.scans.size(), 5u);
    EXPECT_EQ(kept.scans.front().first, 0u);
    for (std::size_t i = 0; i < kept.points.size(); ++i) {
      const auto off_m = [&](const Eigen::Vector3f& point) {
        return (point - kept.points[i]).squaredNorm();
      };
      const float least = off_m(*std::ranges::min_element(cloud.points, {}, off_m));
      bool is_that_of_a_nearest = false;
      for (std::size_t k = 0; k < cloud.points.size(); ++k) {
        if (off_m(cloud.points[k]) > least + 1e-6f) continue;
        is_that_of_a_nearest |= sensor_of(cloud, k) == sensor_of(kept, i);
      }
      EXPECT_TRUE(is_that_of_a_nearest) << "point " << i;
    }
  }
}

std::size_t points_of(const std::string& bytes, const std::string& name,
                      const CloudFilter& filter) {
  return parse_point_cloud(bytes, name, filter).points.size();
}

// Class, return, number of returns and intensity of four points.
const std::string kText =
    "x,y,z,Classification,Return_Number,NumberOfReturns,scalar_Intensity\n"
    "1,0,0,2,1,1,10\n2,0,0,6,1,2,20\n3,0,0,7,2,2,30\n4,0,0,2,2,3,40\n";

TEST(CloudFilterOfAttributes, KeepsWhatPointsSayOfThemselves) {
  EXPECT_EQ(points_of(kText, "a.csv", {}), 4u);
  EXPECT_EQ(points_of(kText, "a.csv", {.classes = {2}}), 2u);
  EXPECT_EQ(points_of(kText, "a.csv", {.classes = {2, 6}}), 3u);
  EXPECT_EQ(points_of(kText, "a.csv", {.left_out_classes = {7}}), 3u);
  EXPECT_EQ(points_of(kText, "a.csv", {.returns = {1}}), 2u);
  EXPECT_EQ(points_of(kText, "a.csv", {.last_returns = true}), 2u);
  EXPECT_EQ(points_of(kText, "a.csv", {.intensity = ValueRange{20, 30}}), 2u);
  EXPECT_EQ(points_of(kText, "a.csv", {.classes = {2}, .returns = {2}}), 1u);
  const PointCloud none = parse_point_cloud(kText, "a.csv", {.classes = {99}});
  EXPECT_TRUE(none.points.empty());
  EXPECT_EQ(none.filtered_out, 4u);
}

TEST(CloudFilterOfAttributes, RefusesCloudsThatDoNotSayThem) {
  EXPECT_THROW(points_of("1 2 3\n", "a.xyz", {.classes = {2}}), InputError);
  EXPECT_THROW(points_of("x,y,z,intensity\n1,2,3,4\n", "a.csv", {.returns = {1}}), InputError);
}

TEST(CloudFilterOfAttributes, IsTheSameInPcdAndPly) {
  const CloudFilter filter{.intensity = ValueRange{20, 30}};
  EXPECT_EQ(points_of("# .PCD v0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\n"
                      "COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
                      "1 0 0 10\n2 0 0 20\n",
                      "a.pcd", filter),
            1u);
  EXPECT_EQ(points_of("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                      "property float y\nproperty float z\nproperty uchar intensity\n"
                      "end_header\n1 0 0 10\n2 0 0 20\n",
                      "a.ply", filter),
            1u);
}

TEST(CloudFilterOfPlaces, LeavesOutTheVehicleAndWhatIsTooFarOrTooHigh) {
  const Box3 box{{1.5, -1, -1}, {3.0, 1, 1}};
  EXPECT_EQ(points_of(kText, "a.csv", {.vehicle_box = box}), 2u);
  PointCloud cloud = parse_point_cloud("1 0 0\n2 0 5\n3 0 0\n4 0 9\n", "a.xyz");
  EXPECT_EQ(within_reach(cloud, {.height_m = ValueRange{1, 6}}).points.size(), 1u);
  const CloudFilter near{.range_m = ValueRange{1.5, 3.5}};
  EXPECT_THROW(within_reach(cloud, near), InputError);
  cloud.sensor_in_source = Eigen::Vector3d(0, 0, 0);
  EXPECT_EQ(within_reach(cloud, near).points.size(), 1u);
}

TEST(CloudFilterOfPlaces, RangesAScanInAFrameOfItsOwnFromThere) {
  std::string scan(2 * 4 * sizeof(float), '\0');
  const float near_m = 2.0f, far_m = 60.0f;
  std::memcpy(scan.data(), &near_m, sizeof near_m);
  std::memcpy(scan.data() + 4 * sizeof(float), &far_m, sizeof far_m);
  const CloudFilter within{.range_m = ValueRange{1, 50}};
  const PointCloud cloud = parse_point_cloud(scan, "a.bin");
  EXPECT_EQ(within_reach(cloud, within).points.size(), 1u);
  EXPECT_EQ(within_reach(scaled_to_metres(cloud, 0.1), within).points.size(), 1u);
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translation().x() = 100.0;
  EXPECT_EQ(within_reach(placed(cloud, away), within).points.size(), 1u);
}

TEST(CloudFilterOfPlaces, NamesNoOptionOfOtherCommandsWhereTheSensorIsNotKnown) {
  const PointCloud cloud = parse_point_cloud("1 0 0\n", "a.xyz");
  try {
    within_reach(cloud, {.range_m = ValueRange{1, 50}});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

TEST(CloudFilterOfPlaces, KeepsEachPointsSensor) {
  PointCloud cloud = parse_point_cloud("1 0 0\n2 0 0\n3 0 0\n4 0 0\n5 0 0\n", "a.xyz");
  const Eigen::Vector3d at_two(2, 0, 0), at_four(4, 0, 0);
  cloud.scans = {{0, at_two}, {2, std::nullopt}, {3, at_four}};
  const PointCloud high = within_reach(cloud, {.height_m = ValueRange{1, 2}});
  EXPECT_TRUE(high.points.empty() && high.scans.empty());
  cloud.scans = {{0, at_two}, {2, at_two}, {3, at_four}};
  const PointCloud near = within_reach(cloud, {.range_m = ValueRange{0.5, 5}});
  ASSERT_EQ(near.points.size(), 3u);  // at 1, 3 and 5
  ASSERT_EQ(near.scans.size(), 3u);
  EXPECT_EQ(near.scans[1].first, 1u);
  EXPECT_EQ(near.scans[2].first, 2u);
  EXPECT_EQ(near.scans[2].sensor_in_source, at_four);
}

}  // namespace
}  // namespace roadbed::map
