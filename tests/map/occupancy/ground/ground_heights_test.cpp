#include "roadbed/map/occupancy/ground/ground_heights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

const Vector3d kOrigin(500'000.0, 5'400'000.0, 100.0);

// Tilted and curved, 100 m up.
double surface_m(const Vector2d& local) {
  return 0.04 * local.x() - 0.03 * local.y() + 0.8 * std::sin(local.x() / 25.0) +
         0.5 * std::cos(local.y() / 30.0);
}

PointCloud cloud_of(const std::vector<Vector3d>& local) {
  PointCloud cloud;
  cloud.name = "made";
  cloud.origin_in_source = kOrigin;
  for (const Vector3d& point : local) cloud.points.push_back(point.cast<float>());
  return cloud;
}

std::vector<Vector3d> ground_points(double from_x_m, double to_x_m, double noise_m = 0.0) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> aside(-0.08, 0.08);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Vector3d> points;
  for (double x = from_x_m; x <= to_x_m; x += 0.2) {
    for (double y = -20.0; y <= 20.0; y += 0.2) {
      const Vector2d at(x + aside(random), y + aside(random));
      points.emplace_back(at.x(), at.y(), surface_m(at) + noise_m * noise(random));
    }
  }
  return points;
}

std::vector<Vector2d> places(double from_x_m, double to_x_m) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> x(from_x_m, to_x_m), y(-17.0, 17.0);
  std::vector<Vector2d> at;
  for (int i = 0; i < 300; ++i) at.emplace_back(x(random), y(random));
  return at;
}

std::vector<std::optional<double>> heights(const std::vector<PointCloud>& clouds,
                                           const std::vector<Vector2d>& local) {
  std::vector<Vector2d> in_source;
  for (const Vector2d& at : local) in_source.emplace_back(at + kOrigin.head<2>());
  return ground_heights(clouds, in_source);
}

void expect_surface(const std::vector<std::optional<double>>& heights_m,
                    const std::vector<Vector2d>& local, double within_m) {
  for (std::size_t i = 0; i < local.size(); ++i) {
    ASSERT_TRUE(heights_m[i]) << local[i].transpose();
    EXPECT_NEAR(*heights_m[i] - kOrigin.z(), surface_m(local[i]), within_m) << local[i].transpose();
  }
}

TEST(GroundHeights, AreThoseOfACurvedSurface) {
  const std::vector<Vector2d> at = places(-17, 17);
  expect_surface(heights({cloud_of(ground_points(-20, 20))}, at), at, 0.003);
}

TEST(GroundHeights, AreNotLowByNoise) {
  const std::vector<Vector2d> at = places(-17, 17);
  const auto heights_m = heights({cloud_of(ground_points(-20, 20, 0.02))}, at);
  expect_surface(heights_m, at, 0.015);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    sum_m += *heights_m[i] - kOrigin.z() - surface_m(at[i]);
  }
  EXPECT_NEAR(sum_m / static_cast<double>(at.size()), 0.0, 0.001);
}

// Crowns with the ground seen below, trunks, walls, cars that hide the ground, and echoes from
// below it.
TEST(GroundHeights, LookPastWhatStandsOnTheGround) {
  std::vector<Vector3d> points = ground_points(-20, 20);
  std::erase_if(points, [](const Vector3d& point) {  // under a car
    return std::abs(point.x() - 5.0) < 0.9 && std::abs(point.y() + 5.0) < 2.2;
  });
  std::mt19937 random(5);
  std::uniform_real_distribution<double> side(-1.0, 1.0), part(0.0, 1.0);
  const auto add = [&](double x, double y, double up_m) {
    points.emplace_back(x, y, surface_m({x, y}) + up_m);
  };
  for (int i = 0; i < 4000; ++i) {
    add(-8.0 + 4.0 * side(random), 6.0 + 4.0 * side(random), 2.0 + 4.0 * part(random));
    add(-8.0 + 0.2 * side(random), 6.0 + 0.2 * side(random), 3.0 * part(random));
    add(10.0 + 0.02 * side(random), 15.0 * side(random), 4.0 * part(random));
    add(5.0 + 0.9 * side(random), -5.0 + 2.2 * side(random), 1.5);
  }
  for (int i = 0; i < 60; ++i) add(18.0 * side(random), 18.0 * side(random), -3.0 * part(random));
  const std::vector<Vector2d> at = places(-17, 17);
  const auto heights_m = heights({cloud_of(points)}, at);
  std::size_t known = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!heights_m[i]) continue;
    ++known;
    EXPECT_NEAR(*heights_m[i] - kOrigin.z(), surface_m(at[i]), 0.02) << at[i].transpose();
  }
  EXPECT_GT(known, at.size() * 95 / 100);
}

TEST(GroundHeights, AreOfTheLowestSurface) {
  std::vector<Vector3d> points = ground_points(-20, 20);
  for (const Vector3d& point : ground_points(-5, 5)) {
    points.emplace_back(point + Vector3d(0, 0, 5.5));  // a bridge
  }
  const std::vector<Vector2d> at = places(-4, 4);
  expect_surface(heights({cloud_of(points)}, at), at, 0.003);
}

TEST(GroundHeights, AreNotToldBeyondWhatWasMeasured) {
  const std::vector<Vector2d> at = places(-17, 17);
  const auto heights_m = heights({cloud_of(ground_points(-20, 0))}, at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i].x() > 0.2) {
      EXPECT_FALSE(heights_m[i]) << at[i].transpose();
    }
    if (at[i].x() > -0.5) continue;
    ASSERT_TRUE(heights_m[i]) << at[i].transpose();
    EXPECT_NEAR(*heights_m[i] - kOrigin.z(), surface_m(at[i]), 0.003);
  }
}

// Leaves on a crown are no ground where none is seen below.
TEST(GroundHeights, AreNotThoseOfLeaves) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> side(-6.0, 6.0), up(2.0, 6.0);
  std::vector<Vector3d> points;
  for (int i = 0; i < 6000; ++i) points.emplace_back(side(random), side(random), up(random));
  std::size_t known = 0;
  for (const auto& height_m : heights({cloud_of(points)}, places(-3, 3))) known += height_m ? 1 : 0;
  EXPECT_LT(known, 30u);
}

TEST(GroundHeights, OfSeveralCloudsAreThoseOfAll) {
  const std::vector<Vector2d> at = places(-17, 17);
  const std::vector<PointCloud> both = {cloud_of(ground_points(-20, 0)),
                                        cloud_of(ground_points(0.1, 20))};
  expect_surface(heights(both, at), at, 0.003);
}

TEST(GroundHeights, OfCellsAreWithinHalfACell) {
  const std::vector<PointCloud> clouds = {cloud_of(ground_points(-20, 20))};
  const OccupancyMap octree = OccupancyMap::build(clouds, {.resolution_m = 0.1});
  const std::vector<Vector2d> local = places(-17, 17);
  std::vector<Vector2d> in_source;
  for (const Vector2d& at : local) in_source.emplace_back(at + kOrigin.head<2>());
  expect_surface(ground_heights(octree, in_source), local, 0.05);
}

TEST(GroundHeights, OfNoPointsAreNone) {
  EXPECT_TRUE(ground_heights(std::vector<PointCloud>{}, {}).empty());
  EXPECT_FALSE(ground_heights(std::vector<PointCloud>{}, std::vector<Vector2d>{{1, 1}})[0]);
}

}  // namespace
}  // namespace roadbed::map
