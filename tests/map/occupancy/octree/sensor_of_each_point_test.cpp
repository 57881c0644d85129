#include <fmt/format.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/clouds/sensor_poses.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map {
namespace {

constexpr double kResolution_m = 0.25;

/// A point and where it was measured from.
struct Shot {
  Eigen::Vector3f point, sensor;
};

/// Shots in runs of one sensor position each.
std::vector<std::vector<Shot>> random_runs(std::mt19937& random, int runs, int longest) {
  std::uniform_real_distribution<float> place(-6.0f, 6.0f), up(-1.0f, 1.0f);
  std::vector<std::vector<Shot>> all;
  for (int run = 0; run < runs; ++run) {
    const Eigen::Vector3f sensor(place(random), place(random), up(random));
    all.emplace_back();
    for (int i = 0; i < 1 + run % longest; ++i) {
      all.back().push_back({{place(random), place(random), up(random)}, sensor});
    }
  }
  return all;
}

std::vector<Shot> in_a_row(const std::vector<std::vector<Shot>>& runs) {
  std::vector<Shot> shots;
  for (const auto& run : runs) shots.insert(shots.end(), run.begin(), run.end());
  return shots;
}

std::string row_of(const Shot& shot, char separator) {
  std::string row;
  for (const Eigen::Vector3f& part : {shot.sensor, shot.point}) {
    for (const float value : part) row += fmt::format("{}{}", value, separator);
  }
  row.back() = '\n';
  return row;
}

std::string csv_of(const std::vector<Shot>& shots) {
  std::string text = "sensor_x,sensor_y,sensor_z,x,y,z\n";
  for (const Shot& shot : shots) text += row_of(shot, ',');
  return text;
}

std::string floats_of(const std::vector<Shot>& shots) {
  std::string bytes;
  for (const Shot& shot : shots) {
    for (const Eigen::Vector3f& part : {shot.sensor, shot.point}) {
      bytes.append(reinterpret_cast<const char*>(part.data()), 3 * sizeof(float));
    }
  }
  return bytes;
}

std::string pcd_of(const std::vector<Shot>& shots, const std::string& data) {
  std::string text = fmt::format(
      "VERSION 0.7\nFIELDS vp_x vp_y vp_z x y z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nWIDTH {}\n"
      "HEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nDATA {}\n",
      shots.size(), data);
  if (data == "binary") return text + floats_of(shots);
  for (const Shot& shot : shots) text += row_of(shot, ' ');
  return text;
}

std::string ply_of(const std::vector<Shot>& shots, const std::string& encoding) {
  std::string text = fmt::format("ply\nformat {} 1.0\nelement vertex {}\n", encoding, shots.size());
  for (const char* name : {"x_origin", "y_origin", "z_origin", "x", "y", "z"}) {
    text += fmt::format("property float {}\n", name);
  }
  text += "end_header\n";
  if (encoding != "ascii") return text + floats_of(shots);
  for (const Shot& shot : shots) text += row_of(shot, ' ');
  return text;
}

std::string bt_of(octomap::OcTree& tree) {
  tree.toMaxLikelihood();
  tree.prune();
  std::ostringstream binary;
  tree.writeBinaryData(binary);
  return "\ndata\n" + binary.str();
}

octomap::point3d to_octomap(const Eigen::Vector3f& point) {
  return {point.x(), point.y(), point.z()};
}

const OccupancyOptions kNotSticky{.resolution_m = kResolution_m, .sticky_hits = false};

TEST(SensorOfEachPoint, LeftAtZeroInAllPointsSaysNothing) {
  const std::string header =
      "VERSION 0.7\nFIELDS x y z vp_x vp_y vp_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nWIDTH 2\n"
      "HEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nDATA ascii\n";
  const PointCloud left = parse_point_cloud(header + "4 5 6 0 0 0\n7 8 9 0 0 0\n", "left.pcd");
  EXPECT_TRUE(left.scans.empty());
  EXPECT_EQ(left.sensor_in_source, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(left.notes.size(), 1U);
  const PointCloud set = parse_point_cloud(header + "4 5 6 0 0 0\n7 8 9 0 0 1\n", "set.pcd");
  EXPECT_EQ(set.scans.size(), 2U);
  EXPECT_FALSE(set.sensor_in_source);
  EXPECT_EQ(set.notes.size(), 1U);
}

TEST(SensorOfEachPoint, EveryFormatGivesTheTreeOfInsertPointCloudForEachRun) {
  std::mt19937 random(1);
  const auto runs = random_runs(random, 60, 9);
  octomap::OcTree theirs(kResolution_m);
  for (const auto& run : runs) {
    octomap::Pointcloud points;
    for (const Shot& shot : run) points.push_back(to_octomap(shot.point));
    theirs.insertPointCloud(points, to_octomap(run[0].sensor), -1.0, false, true);
  }
  const std::string expected = bt_of(theirs);
  const std::vector<Shot> shots = in_a_row(runs);
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"a.csv", csv_of(shots)},
           {"ascii.pcd", pcd_of(shots, "ascii")},
           {"binary.pcd", pcd_of(shots, "binary")},
           {"ascii.ply", ply_of(shots, "ascii")},
           {"binary.ply", ply_of(shots, "binary_little_endian")}}) {
    const PointCloud cloud = parse_point_cloud(bytes, name);
    EXPECT_EQ(cloud.points.size(), shots.size()) << name;
    EXPECT_EQ(cloud.scans.size(), runs.size()) << name;
    EXPECT_FALSE(cloud.sensor_in_source) << name;
    const auto file = OccupancyMap::build_bt(std::vector{cloud}, kNotSticky);
    EXPECT_TRUE(file.bytes.ends_with(expected)) << name;
  }
}

TEST(SensorOfEachPoint, APointAScanIsTheTreeOfInsertRay) {
  std::mt19937 random(2);
  std::vector<Shot> shots = in_a_row(random_runs(random, 300, 1));
  octomap::OcTree theirs(kResolution_m);
  for (Shot& shot : shots) {
    const octomap::point3d end = theirs.keyToCoord(theirs.coordToKey(to_octomap(shot.point)));
    shot.point = {end.x(), end.y(), end.z()};  // rays are drawn to the middle of a cell
    theirs.insertRay(to_octomap(shot.sensor), end);
  }
  const PointCloud cloud = parse_point_cloud(csv_of(shots), "a.csv");
  const auto file = OccupancyMap::build_bt(std::vector{cloud}, kNotSticky);
  EXPECT_TRUE(file.bytes.ends_with(bt_of(theirs)));
}

TEST(SensorOfEachPoint, StickyCloudsOfOnePositionEachAreTheSameFile) {
  std::mt19937 random(3);
  const auto runs = random_runs(random, 40, 5);
  std::vector<PointCloud> apart;
  for (const auto& run : runs) {
    apart.emplace_back().sensor_in_source = run[0].sensor.cast<double>();
    for (const Shot& shot : run) apart.back().points.push_back(shot.point);
  }
  const PointCloud together = parse_point_cloud(csv_of(in_a_row(runs)), "a.csv");
  const OccupancyOptions options{.resolution_m = kResolution_m};
  EXPECT_EQ(OccupancyMap::build_bt(std::vector{together}, options).bytes,
            OccupancyMap::build_bt(apart, options).bytes);
}

TEST(SensorOfEachPoint, LeavesOutPointsAndKeepsHitsWhoseSensorIsNotFinite) {
  const PointCloud cloud = parse_point_cloud(
      "x y z BeamOriginX BeamOriginY BeamOriginZ\n"
      "3 0 0 1 0 0\nnan 0 0 7 7 7\n4 0 0 1 0 0\n0 3 0 nan 0 0\n0 4 0 0 inf 0\n5 0 0 1 0 0\n",
      "a.xyz");
  ASSERT_EQ(cloud.points.size(), 5u);
  EXPECT_EQ(cloud.dropped_not_finite, 1u);
  ASSERT_EQ(cloud.scans.size(), 3u);
  EXPECT_EQ(cloud.scans[1].first, 2u);
  EXPECT_FALSE(cloud.scans[1].sensor_in_source);
  EXPECT_EQ(cloud.scans[2].first, 4u);
  ASSERT_EQ(cloud.notes.size(), 1u);
  EXPECT_TRUE(cloud.notes[0].starts_with("2 points have no finite sensor position"));
  const OccupancyMap map = OccupancyMap::build(std::vector{cloud}, {.resolution_m = kResolution_m});
  EXPECT_EQ(map.at({0.1, 3.1, 0.1}), CellState::occupied);
  EXPECT_EQ(map.at({0.1, 2.1, 0.1}), CellState::unknown);
  EXPECT_EQ(map.at({2.1, 0.1, 0.1}), CellState::free);
}

TEST(SensorOfEachPoint, MovesAndIsScaledWithItsCloud) {
  const PointCloud cloud =
      parse_point_cloud("x y z sensor_x sensor_y sensor_z\n1 2 3 10 0 0\n", "a.xyz");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(100, 200, 5));
  pose.rotate(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  const PointCloud moved = placed(cloud, pose);
  ASSERT_EQ(moved.scans.size(), 1u);
  EXPECT_NEAR((*moved.scans[0].sensor_in_source - Eigen::Vector3d(100, 210, 5)).norm(), 0, 1e-12);
  const PointCloud feet = scaled_to_metres(cloud, 0.3048);
  EXPECT_NEAR(feet.scans.at(0).sensor_in_source->x(), 3.048, 1e-12);
}

TEST(SensorOfEachPoint, ThatIsNotAllThereIsNoSensorAndIsSaid) {
  const PointCloud cloud = parse_point_cloud("x,y,z,sensor_x,sensor_y\n1,2,3,4,5\n", "a.csv");
  EXPECT_FALSE(cloud.has_sensor());
  ASSERT_EQ(cloud.notes.size(), 1u);
  EXPECT_TRUE(cloud.notes[0].starts_with("has sensor_x, but not all of"));
}

TEST(SensorOfEachPoint, ThatIsNoNumberOrIsMissingInALineIsRefused) {
  const std::string header = "x,y,z,sensor_x,sensor_y,sensor_z\n";
  EXPECT_THROW(parse_point_cloud(header + "1,2,3,4,5\n", "a.csv"), InputError);
  EXPECT_THROW(parse_point_cloud(header + "1,2,3,4,5,up\n", "a.csv"), InputError);
  const PointCloud far = parse_point_cloud(header + "1,2,3,4,5,6\n1,2,3,9e8,0,0\n", "a.csv");
  EXPECT_THROW(OccupancyMap::build(std::vector{far}, {}), InputError);
}

}  // namespace
}  // namespace roadbed::map
