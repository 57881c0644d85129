#include "roadbed/map/occupancy/clouds/cloud_transforms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "roadbed/tests/support/program_run.h"

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

class CloudFilterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(tests::program_file().parent_path() /
                                 "../lib/libroadbed_pcl.so")) {
      GTEST_SKIP() << "built without PCL";
    }
  }
};

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

}  // namespace
}  // namespace roadbed::map
