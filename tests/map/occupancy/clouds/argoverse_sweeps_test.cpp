#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = "argoverse2/argoverse+av2-api/7fab2350";
constexpr const char* kSweep = "sensors/lidar/315966265259836000.feather";

double distance_m(const PointCloud& cloud, std::size_t i, const Eigen::Vector3d& expected) {
  return (cloud.in_source(i) - expected).norm();
}

// Numbers by numpy and pyarrow, from the same files.
TEST(ArgoverseSweeps, StandInTheCityAtTheTimeOfTheirName) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const PointCloud cloud = read_point_cloud(folder / kLog / kSweep);
  ASSERT_EQ(cloud.points.size(), 99229u);
  EXPECT_LT(distance_m(cloud, 1000, {5222.853366, 2401.162178, 70.259354}), 1e-3);
  EXPECT_LT(distance_m(cloud, 99228, {5224.624459, 2370.475527, 71.371308}), 1e-3);
  EXPECT_LT(
      (bounds(cloud).max_in_source - Eigen::Vector3d(5400.076062, 2513.604974, 106.372719)).norm(),
      1e-3);
}

// Numbers by numpy and pyarrow: the lidar of its laser, placed by the pose at the point's time. At
// the time of the sweep the upper one was 2.4 mm off its place at the first of them.
TEST(ArgoverseSweeps, SayFromWhereEachPointWasMeasured) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const PointCloud cloud = read_point_cloud(folder / kLog / kSweep);
  const auto sensor_of = [&](std::size_t i) {
    const auto after = std::ranges::upper_bound(cloud.scans, i, {},
                                                [](const ScanStart& one) { return one.first; });
    return (after - 1)->sensor_in_source.value();
  };
  constexpr double slot_of_1_ms_m = 5e-4;
  ASSERT_FALSE(cloud.scans.empty());
  const auto off_m = [&](std::size_t i, const Eigen::Vector3d& truth) {
    return (sensor_of(i) - truth).norm();
  };
  EXPECT_LT(off_m(1000, {5224.89311767, 2384.69139755, 70.76993859}), slot_of_1_ms_m);
  EXPECT_LT(off_m(50000, {5224.92347524, 2384.67996373, 70.65646051}), slot_of_1_ms_m);
  EXPECT_LT(off_m(99228, {5224.9547935, 2384.66366508, 70.65846209}), slot_of_1_ms_m);
}

TEST(ArgoverseSweeps, StandInTheVehiclesFrameWithoutPoses) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const std::string bytes = read_file(folder / kLog / kSweep);
  const PointCloud cloud = parse_point_cloud(bytes, "sweep.feather");
  EXPECT_EQ(cloud.in_source(0), Eigen::Vector3d(-1.537109375, 3.060546875, -0.322509765625));
}

TEST(ArgoverseSweeps, AreRefusedAtATimeWithoutPose) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const fs::path log = fs::path(testing::TempDir()) / "sweeps_without_pose";
  fs::create_directories(log / "sensors/lidar");
  const char* poses = "city_SE3_egovehicle.feather";
  const auto copied = fs::copy_options::overwrite_existing;
  fs::copy_file(folder / kLog / poses, log / poses, copied);
  const fs::path early = log / "sensors/lidar/1.feather";
  fs::copy_file(folder / kLog / kSweep, early, copied);
  EXPECT_THROW(read_point_cloud(early), InputError);
  fs::copy_file(folder / kLog / kSweep, log / "sensors/lidar/sweep.feather", copied);
  EXPECT_EQ(read_point_cloud(log / "sensors/lidar/sweep.feather").notes.size(), 1u);
  fs::remove_all(log);
}

TEST(ArgoverseSweeps, AreNotTakenFromOtherFeather) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  EXPECT_THROW(read_point_cloud(folder / kLog / "annotations.feather"), InputError);
}

}  // namespace
}  // namespace roadbed::map
