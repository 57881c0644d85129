#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

Ground any_ground(std::mt19937& random, int places) {
  std::uniform_real_distribution<double> place(-8.0, 8.0), height(-0.5, 0.5), slope(-0.2, 0.2);
  std::vector<GroundPlace> all;
  for (int i = 0; i < places; ++i) {
    all.push_back({{place(random), place(random)}, height(random), {slope(random), slope(random)}});
  }
  return Ground(std::move(all));
}

double plain_height(const Ground& ground, const Vector2d& at) {
  double least_m = std::numeric_limits<double>::infinity(), height_m = 0.0;
  for (const GroundPlace& place : ground.places()) {
    const double away_m = (place.in_source - at).norm();
    if (away_m >= least_m) continue;
    least_m = away_m;
    height_m = place.z_m + place.slope.dot(at - place.in_source);
  }
  return height_m;
}

TEST(Ground, IsThePlaneOfTheNearestPlace) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  const Ground ground = any_ground(random, 30);
  for (int i = 0; i < 500; ++i) {
    const Vector2d at(place(random), place(random));
    EXPECT_NEAR(ground.height_m(at), plain_height(ground, at), 1e-12);
  }
  EXPECT_FALSE(ground.is_level());
  EXPECT_TRUE(Ground({{{0, 0}, 2.0, {0, 0}}, {{5, 1}, 2.0, {0, 0}}}).is_level());
  EXPECT_THROW(Ground({}), std::invalid_argument);
  EXPECT_THROW(Ground({{{0, 0}, std::nan(""), {0, 0}}}), std::invalid_argument);
}

/// Hits and rays at all heights, so that columns are measured in part.
OccupancyMap half_measured_world(std::mt19937& random) {
  std::uniform_real_distribution<float> place(-5.0f, 5.0f), height(-1.0f, 2.5f);
  std::vector<PointCloud> clouds;
  for (int i = 0; i < 30; ++i) {
    PointCloud cloud;
    cloud.points.emplace_back(place(random), place(random), height(random));
    if (i % 2 == 0) {
      cloud.sensor_in_source = Eigen::Vector3d(cloud.points[0].x(), cloud.points[0].y(),
                                               i % 4 == 0 ? 4.0 : cloud.points[0].z() + 0.8);
    }
    clouds.push_back(cloud);
  }
  return OccupancyMap::build(clouds, {.resolution_m = 0.2});
}

struct PlainColumn {
  double measured_m = 0.0;
  bool occupied = false;
};

// One cell of the octree after another, whatever it is for.
PlainColumn plain_column_at(const std::vector<OccupancyCell>& cells, const HeightBand& band,
                            const Vector2d& middle) {
  PlainColumn column;
  for (const OccupancyCell& cell : cells) {
    const Vector2d off = cell.centre_in_source.head<2>() - middle;
    if (off.cwiseAbs().maxCoeff() > 0.5 * cell.size_m) continue;
    const double low_m =
        cell.centre_in_source.z() - 0.5 * cell.size_m - plain_height(*band.ground, middle);
    const double overlap_m =
        std::min(low_m + cell.size_m, band.to_m) - std::max(low_m, band.from_m);
    if (overlap_m <= 1e-6) continue;
    column.measured_m += overlap_m;
    column.occupied = column.occupied || cell.state == CellState::occupied;
  }
  return column;
}

TEST(LevelledBand, SeesInEachColumnWhatReachesIntoTheBandOverItsGround) {
  std::mt19937 random(5);
  int occupied = 0, whole = 0, partly = 0;
  for (int round = 0; round < 8; ++round) {
    const OccupancyMap world = half_measured_world(random);
    const auto cells = world.cells();
    const Ground ground = any_ground(random, 12);
    const HeightBand band{0.25, 1.3, &ground};
    const ClearanceField field(world, band, FieldRegion{{{-6, -6}, {6, 6}}, 3.0});
    for (double x = -4.9; x < 5.0; x += 0.2) {
      for (double y = -4.9; y < 5.0; y += 0.2) {
        const PlainColumn column = plain_column_at(cells, band, {x, y});
        const geometry::Rectangle point{.centre = {x, y}};
        const auto near = field.nearest(point, 0.01);
        EXPECT_EQ(near.has_value() && near->distance_m == 0.0, column.occupied);
        const geometry::Rectangle inside{
            .centre = {x, y}, .half_length_m = 0.05, .half_width_m = 0.05};
        const double unknown = field.unknown_fraction(inside);
        const double expected = column.occupied ? 0.0 : 1.0 - column.measured_m / 1.05;
        EXPECT_NEAR(unknown, std::max(0.0, expected), 2e-3);
        occupied += column.occupied;
        whole += unknown == 0.0 && !column.occupied;
        partly += unknown > 0.01 && unknown < 0.99;
      }
    }
  }
  EXPECT_GT(occupied, 50);
  EXPECT_GT(whole, 20);
  EXPECT_GT(partly, 5);
}

TEST(LevelledBand, OverLevelGroundIsTheBandItself) {
  std::mt19937 random(6);
  const OccupancyMap world = half_measured_world(random);
  const Ground ground({{{0, 0}, 0.4, {0, 0}}});
  const FieldRegion region{{{-6, -6}, {6, 6}}, 5.0};
  const ClearanceField levelled(world, {0.2, 1.2, &ground}, region);
  const ClearanceField plain(world, {0.6, 1.6}, region);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  for (int i = 0; i < 300; ++i) {
    const geometry::Rectangle box{
        .centre = {place(random), place(random)}, .half_length_m = 0.3, .half_width_m = 0.2};
    for (const ObstacleKind kind : {ObstacleKind::occupied, ObstacleKind::unknown}) {
      const auto a = levelled.nearest(box, 4.0, kind), b = plain.nearest(box, 4.0, kind);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        EXPECT_NEAR(a->distance_m, b->distance_m, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace roadbed::map
