// PCL's ground of real octrees, held against the robust plane through the lowest of each column
// (ground/ground_heights.h) and against what an audit demands of measured ground.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/map/occupancy/ground/ground_heights.h"
#include "roadbed/map/occupancy/objects/ground_segmentation.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"
#include "roadbed/tests/support/needs_pcl.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

class RealGround : public tests::NeedsPcl {};

PointCloud cells_of(const OccupancyMap& octree) {
  PointCloud cloud;
  cloud.origin_in_source = octree.origin_in_source();
  for (const Eigen::Vector3d& centre : occupied_centres(octree, "octree")) {
    cloud.points.push_back((centre - cloud.origin_in_source).cast<float>());
  }
  return cloud;
}

std::vector<Eigen::Vector3d> ground_of(const PointCloud& cloud) {
  const GroundSegmentation found = segment_ground(cloud);
  std::vector<Eigen::Vector3d> ground;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (found.is_ground[i]) ground.push_back(cloud.in_source(i));
  }
  return ground;
}

/// The mean height of ground within 2 m, where there is some on all four sides.
std::optional<double> height_m(const std::vector<Eigen::Vector3d>& ground,
                               const Eigen::Vector2d& at) {
  std::array<int, 4> on_side{};
  double sum_m = 0.0;
  for (const Eigen::Vector3d& point : ground) {
    const Eigen::Vector2d off = point.head<2>() - at;
    if (off.norm() > 2.0) continue;
    ++on_side[(off.x() > 0.0 ? 2U : 0U) + (off.y() > 0.0 ? 1U : 0U)];
    sum_m += point.z();
  }
  constexpr int few = 3;
  if (*std::ranges::min_element(on_side) <= few) return std::nullopt;
  return sum_m / (on_side[0] + on_side[1] + on_side[2] + on_side[3]);
}

struct Compared {
  int by_pcl = 0, by_plane = 0, too_high = 0, too_low = 0;
};

Compared compare(const OccupancyMap& octree, const PointCloud& cloud,
                 const std::vector<Eigen::Vector3d>& ground) {
  std::mt19937 random(3);
  std::vector<Eigen::Vector2d> places;
  for (int k = 0; k < 300; ++k) {
    places.push_back(cloud.in_source(random() % cloud.points.size()).head<2>());
  }
  const auto planes = ground_heights(octree, places);
  Compared found;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::optional<double> z_m = height_m(ground, places[k]);
    if (z_m) ++found.by_pcl;
    if (planes[k]) ++found.by_plane;
    if (z_m && planes[k] && *z_m > *planes[k] + 0.1) ++found.too_high;
    if (z_m && planes[k] && *z_m < *planes[k] - 0.1) ++found.too_low;
  }
  return found;
}

int poses_that_audits_take(const OccupancyMap& octree, const PointCloud& cloud, int poses) {
  std::mt19937 random(2);
  int taken = 0;
  for (int k = 0; k < poses; ++k) {
    const Eigen::Vector2d at = cloud.in_source(random() % cloud.points.size()).head<2>();
    const geometry::Trajectory standing({{.t_s = 0.0, .x_m = at.x(), .y_m = at.y()}});
    try {
      measured_under(octree, standing, {-0.8, 3.7});
      ++taken;
    } catch (const InputError&) {
    }
  }
  return taken;
}

void compare_file(const std::filesystem::path& file) {
  constexpr int poses = 50;
  const OccupancyMap octree = OccupancyMap::load(file);
  const PointCloud all = cells_of(octree);
  const PointCloud inliers = filtered(all, {.outlier_neighbours = 8, .outlier_deviations = 1.0});
  const std::vector<Eigen::Vector3d> of_all = ground_of(all), of_inliers = ground_of(inliers);
  const Compared found = compare(octree, inliers, of_inliers);
  fmt::print(
      "{}: PCL takes {} of {} cells for ground, without outliers {}; of 300 places it has ground "
      "on all sides at {}, the robust plane at {}; {} are over 0.1 m above that, {} below; an "
      "audit takes measured ground at {} of {} poses\n",
      file.filename().string(), of_all.size(), all.points.size(), of_inliers.size(), found.by_pcl,
      found.by_plane, found.too_high, found.too_low, poses_that_audits_take(octree, all, poses),
      poses);
  EXPECT_EQ(found.too_high, 0);
  EXPECT_LT(found.by_pcl, found.by_plane);
}

TEST_F(RealGround, OfOctreesIsNotAboveTheRobustPlaneAndIsFoundAtFewerPlaces) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  compare_file(folder / "occupancy/robotics-upo+dll/catec.bt");
  compare_file(folder / "occupancy/OctoMap+octomap/geb079.bt");
}

}  // namespace
}  // namespace roadbed::map
