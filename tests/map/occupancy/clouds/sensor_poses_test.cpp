#include "roadbed/map/occupancy/clouds/sensor_poses.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

Eigen::Isometry3d any_sensor_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1e5, 1e5), part(-1.0, 1.0);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(part(random), part(random), part(random), part(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(place(random), place(random), place(random));
  return pose;
}

std::string tum_line(double t_s, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d p = pose.translation();
  return fmt::format("{} {} {} {} {} {} {} {}\n", t_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                     q.w());
}

std::string kitti_line(const Eigen::Isometry3d& pose) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) line += fmt::format("{} ", pose(row, column));
  }
  return line + "\n";
}

TEST(SensorPoses, BothFormsGiveBackThePoses) {
  std::mt19937 random(1);
  std::vector<Eigen::Isometry3d> poses;
  std::string tum = "# timestamp tx ty tz qx qy qz qw\n\n", kitti;
  for (int i = 0; i < 20; ++i) {
    poses.push_back(any_sensor_pose(random));
    tum += tum_line(1.5e9 + i, poses.back());
    kitti += kitti_line(poses.back());
  }
  const auto from_tum = parse_sensor_poses(tum, "poses.txt");
  const auto from_kitti = parse_sensor_poses(kitti, "poses.txt");
  ASSERT_EQ(from_tum.size(), poses.size());
  ASSERT_EQ(from_kitti.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(from_tum[i].matrix().isApprox(poses[i].matrix(), 1e-12));
    EXPECT_TRUE(from_kitti[i].matrix().isApprox(poses[i].matrix(), 1e-12));
  }
}

TEST(SensorPoses, AQuarterTurnToTheLeftBringsWhatIsAheadToTheLeft) {
  const auto pose = parse_sensor_poses("0 100 200 5 0 0 0.70710678 0.70710678\n", "p").front();
  PointCloud cloud;
  cloud.points = {{10.0f, 0.0f, 1.0f}, {0.0f, 2.0f, -1.0f}};
  const PointCloud world = placed(cloud, pose);
  EXPECT_NEAR((world.in_source(0) - Eigen::Vector3d(100, 210, 6)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((world.in_source(1) - Eigen::Vector3d(98, 200, 4)).norm(), 0.0, 1e-5);
  EXPECT_EQ(*world.sensor_in_source, Eigen::Vector3d(100, 200, 5));
}

TEST(SensorPoses, KeepMillimetresFarFromTheOrigin) {
  PointCloud cloud;
  cloud.points = {{1.234f, -2.345f, 0.456f}};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(691234.567, 5334567.891, 512.345);
  const PointCloud world = placed(cloud, pose);
  const Eigen::Vector3d expected = pose.translation() + Eigen::Vector3d(1.234, -2.345, 0.456);
  EXPECT_NEAR((world.in_source(0) - expected).norm(), 0.0, 1e-3);
}

TEST(SensorPoses, AreRefusedWithTheirLine) {
  const auto expect_refused = [](const std::string& text, const char* reason) {
    try {
      parse_sensor_poses(text, "poses.txt");
      FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
  };
  expect_refused("", "holds no pose");
  expect_refused("# nothing\n\n", "holds no pose");
  expect_refused("1 2 3\n", "poses.txt:1: has 3 numbers");
  expect_refused("0 0 0 0 0 0 0 1\n1 0 0 0 1 0 0 0 1 0 0 0\n", "poses.txt:2: has 12 numbers");
  expect_refused("0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n", "poses.txt:2: 0 s does not come after");
  expect_refused("0 0 0 0 0 0 0 0\n", "quaternion of length 0");
  expect_refused("0 nan 0 0 0 0 0 1\n", "\"nan\"");
  expect_refused("0 1e10 0 0 0 0 0 1\n", "beyond any Earth frame");
  expect_refused("1 0 0 0 0 1 0 0 0 0 2 0\n", "no rotation");
  expect_refused("1 0 0 0 0 1 0 0 0 0 -1 0\n", "no rotation");
  expect_refused("x\n", "\"x\"");
}

}  // namespace
}  // namespace roadbed::map
