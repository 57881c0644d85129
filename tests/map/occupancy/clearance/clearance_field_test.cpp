#include "roadbed/map/occupancy/clearance/clearance_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tests/support/brute_force_distance.h"

namespace roadbed::map {
namespace {

using geometry::Pose2;
using geometry::VehicleShape;
using tests::Quad;

constexpr HeightBand kBand{0.2, 1.5};

/// Hits here and there, some of them filling whole leaves of 2 and 4 cells.
OccupancyMap random_occupancy(std::mt19937& random, double resolution_m, double extent_m) {
  std::uniform_real_distribution<double> place(-extent_m, extent_m), height(-1.0, 3.0);
  PointCloud cloud;
  cloud.origin_in_source = {5000.0, -20.0, 0.0};
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d at(place(random), place(random), height(random));
    const int side = 1 << random() % 3;
    for (int n = 0; n < side * side * side; ++n) {
      const Eigen::Vector3d step(n % side, n / side % side, n / (side * side));
      cloud.points.emplace_back((at + resolution_m * step).cast<float>());
    }
  }
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = resolution_m});
}

std::vector<Quad> occupied_boxes(const OccupancyMap& occupancy, const HeightBand& band) {
  std::vector<Quad> boxes;
  for (const OccupancyCell& cell : occupancy.cells()) {
    const double half = 0.5 * cell.size_m, z = cell.centre_in_source.z();
    if (cell.state != CellState::occupied) continue;
    if (z + half <= band.from_m + 1e-6 || z - half >= band.to_m - 1e-6) continue;
    const Eigen::Vector2d centre = cell.centre_in_source.head<2>();
    boxes.push_back(tests::box_quad(centre.array() - half, centre.array() + half));
  }
  return boxes;
}

Quad vehicle_quad(const Pose2& pose, const VehicleShape& shape) {
  const auto corners = shape.corners_in_vehicle();
  return {pose * corners[0], pose * corners[1], pose * corners[2], pose * corners[3]};
}

double brute_force(const std::vector<Quad>& boxes, const Quad& vehicle) {
  double least = std::numeric_limits<double>::infinity();
  for (const Quad& box : boxes) least = std::min(least, tests::quad_distance(box, vehicle));
  return least;
}

Pose2 random_pose(std::mt19937& random, double extent_m) {
  std::uniform_real_distribution<double> place(-extent_m, extent_m), turn(-4.0, 4.0);
  return {5000.0 + place(random), -20.0 + place(random), turn(random)};
}

TEST(ClearanceField, NearestEqualsBruteForceOverAllOccupiedLeaves) {
  std::mt19937 random(20261121);
  const VehicleShape shape;
  for (int round = 0; round < 40; ++round) {
    const OccupancyMap occupancy = random_occupancy(random, round % 2 == 0 ? 0.1 : 0.37, 15.0);
    const ClearanceField field(occupancy, kBand);
    const auto boxes = occupied_boxes(occupancy, kBand);
    for (int i = 0; i < 50; ++i) {
      const Pose2 pose = random_pose(random, 25.0);
      const double expected = brute_force(boxes, vehicle_quad(pose, shape));
      const auto nearest = field.nearest(pose, shape, 100.0);
      if (boxes.empty()) {
        EXPECT_FALSE(nearest);
        continue;
      }
      ASSERT_TRUE(nearest);
      EXPECT_NEAR(nearest->distance_m, expected, 1e-7);
      const Quad witness =
          tests::box_quad(nearest->witness.min_in_source, nearest->witness.max_in_source);
      EXPECT_NEAR(tests::quad_distance(witness, vehicle_quad(pose, shape)), expected, 1e-7);
      EXPECT_FALSE(expected > 0.01 && field.nearest(pose, shape, expected - 0.01));
      EXPECT_TRUE(field.nearest(pose, shape, expected + 0.01));
    }
  }
}

bool lies_among(const std::vector<Quad>& boxes, const Eigen::Vector2d& point) {
  if (boxes.empty()) return false;
  Eigen::Vector2d least = boxes.front()[0], most = boxes.front()[2];
  for (const Quad& box : boxes) {
    least = least.cwiseMin(box[0]);
    most = most.cwiseMax(box[2]);
  }
  return (point.array() >= least.array()).all() && (point.array() <= most.array()).all();
}

TEST(ClearanceField, BoundIsNeverAboveTheTrueDistanceAndAtMostTwoCellDiagonalsBelow) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    const double cell_m = 0.2;
    const OccupancyMap occupancy = random_occupancy(random, cell_m, 10.0);
    const ClearanceField field(occupancy, kBand);
    const auto boxes = occupied_boxes(occupancy, kBand);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d point = random_pose(random, 20.0).position();
      const Quad speck = tests::box_quad(point, point.array() + 1e-9);
      const double expected = std::min(brute_force(boxes, speck), field.horizon_m());
      EXPECT_LE(field.distance_bound_m(point), expected + 1e-8);
      if (lies_among(boxes, point)) {
        EXPECT_GE(field.distance_bound_m(point), expected - 2.0 * std::sqrt(2.0) * cell_m);
      }
    }
  }
}

TEST(ClearanceField, OnlyCellsInTheBandCount) {
  PointCloud cloud;
  cloud.points = {{0.05f, 0.05f, 0.15f}, {5.05f, 0.05f, 1.55f}, {10.05f, 0.05f, 0.25f}};
  const OccupancyMap occupancy = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
  const ClearanceField field(occupancy, kBand);
  const auto nearest = field.nearest({0, 0, 0}, VehicleShape{}, 100.0);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance_m, 10.0 - VehicleShape{}.front_m(), 1e-9);
  EXPECT_FALSE(ClearanceField(occupancy, {3.0, 4.0}).nearest({0, 0, 0}, VehicleShape{}, 100.0));
  EXPECT_THROW(ClearanceField(occupancy, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(ClearanceField(occupancy, {0.0, NAN}), std::invalid_argument);
}

TEST(ClearanceField, OfARegionAgreesWithTheWholeWithinItsHorizon) {
  std::mt19937 random(11);
  const OccupancyMap occupancy = random_occupancy(random, 0.1, 30.0);
  const ClearanceField whole(occupancy, kBand);
  const FieldRegion region{{{4990.0, -30.0}, {5010.0, -10.0}}, 8.0};
  const ClearanceField part(occupancy, kBand, region);
  const VehicleShape shape;
  for (int i = 0; i < 300; ++i) {
    const Pose2 pose = random_pose(random, 6.0);
    const auto expected = whole.nearest(pose, shape, 8.0),
               actual = part.nearest(pose, shape, 100.0);
    ASSERT_EQ(expected.has_value(), actual.has_value());
    if (expected) {
      EXPECT_NEAR(expected->distance_m, actual->distance_m, 1e-9);
    }
    const Eigen::Vector2d outside = random_pose(random, 60.0).position();
    EXPECT_LE(part.distance_bound_m(outside), whole.distance_bound_m(outside) + 0.3);
  }
  EXPECT_THROW(part.nearest({5009.0, -20.0, 0.0}, shape, 1.0), std::invalid_argument);
}

/// Hits all around, with rays between some of them that leave the rest unknown.
OccupancyMap scans_between_hits(std::mt19937& random, double extent_m) {
  std::uniform_real_distribution<double> place(-extent_m, extent_m), height(0.0, 1.6);
  std::vector<PointCloud> clouds;
  for (int scan = 0; scan < 6; ++scan) {
    PointCloud cloud;
    cloud.origin_in_source = {5000.0, -20.0, 0.0};
    cloud.sensor_in_source =
        cloud.origin_in_source + Eigen::Vector3d(place(random), place(random), height(random));
    for (int i = 0; i < 60; ++i) {
      cloud.points.push_back(
          Eigen::Vector3d(place(random), place(random), height(random)).cast<float>());
    }
    clouds.push_back(cloud);
  }
  return OccupancyMap::build(clouds, {.resolution_m = 0.1});
}

TEST(ClearanceField, InTilesOfAnySideSaysWhatTheWholeSaysBitForBit) {
  std::mt19937 random(17);
  const VehicleShape shape;
  for (const double tile_m : {0.1, 0.7, 2.0, 5.3, 20.0, 500.0}) {
    const OccupancyMap occupancy = scans_between_hits(random, 15.0);
    const FieldRegion region{.around = {{4980.0, -40.0}, {5020.0, 0.0}}, .horizon_m = 6.0};
    FieldRegion in_tiles = region;
    in_tiles.tile_m = tile_m;
    in_tiles.body_radius_m = 2.5;
    const ClearanceField whole(occupancy, kBand, region), tiles(occupancy, kBand, in_tiles);
    for (int i = 0; i < (tile_m < 1.0 ? 40 : 200); ++i) {
      const Pose2 pose = random_pose(random, 16.0);
      for (const ObstacleKind kind : {ObstacleKind::occupied, ObstacleKind::unknown}) {
        ASSERT_EQ(tiles.distance_bound_m(pose.position(), kind),
                  whole.distance_bound_m(pose.position(), kind));
        const auto expected = whole.nearest(pose, shape, 100.0, kind);
        const auto found = tiles.nearest(pose, shape, 100.0, kind);
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (!found) continue;
        ASSERT_EQ(found->distance_m, expected->distance_m);
        ASSERT_EQ(found->witness.min_in_source, expected->witness.min_in_source);
        ASSERT_EQ(found->witness.max_in_source, expected->witness.max_in_source);
      }
      ASSERT_EQ(tiles.unknown_fraction(pose, shape), whole.unknown_fraction(pose, shape));
    }
  }
}

// As a whole it would have 10¹⁰ cells.
TEST(ClearanceField, OfAnOccupancyTooLargeForOneGridKnowsBothItsEnds) {
  PointCloud cloud;
  std::vector<Quad> boxes;
  for (const double at_m : {0.05, 3000.05, 6000.05}) {
    cloud.points.emplace_back(static_cast<float>(at_m), static_cast<float>(at_m), 0.75f);
    boxes.push_back(tests::box_quad(Eigen::Array2d::Constant(at_m - 0.05),
                                    Eigen::Array2d::Constant(at_m + 0.05)));
  }
  const OccupancyMap occupancy = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
  const ClearanceField field(occupancy, kBand);
  EXPECT_EQ(field.horizon_m(), 50.0);
  const VehicleShape shape;
  std::mt19937 random(19);
  std::uniform_real_distribution<double> place(-30.0, 30.0), turn(-4.0, 4.0);
  for (const double at_m : {0.0, 3000.0, 6000.0, -20'000.0}) {
    for (int i = 0; i < 50; ++i) {
      const Pose2 pose{at_m + place(random), at_m + place(random), turn(random)};
      const double expected_m = brute_force(boxes, vehicle_quad(pose, shape));
      const auto found = field.nearest(pose, shape, 60.0);
      ASSERT_EQ(found.has_value(), expected_m <= 50.0);
      if (found) {
        ASSERT_NEAR(found->distance_m, expected_m, 1e-6);
      }
      ASSERT_LE(field.distance_bound_m(pose.position()), expected_m + shape.length_m);
    }
  }
}

TEST(ClearanceField, RefusesABodyThatItsTilesAreTooSmallFor) {
  std::mt19937 random(18);
  const OccupancyMap occupancy = random_occupancy(random, 0.1, 5.0);
  const ClearanceField tiles(occupancy, kBand,
                             FieldRegion{.around = {{4980.0, -40.0}, {5020.0, 0.0}},
                                         .horizon_m = 6.0,
                                         .tile_m = 4.0,
                                         .body_radius_m = 2.0});
  EXPECT_THROW(tiles.nearest({5000.0, -20.0, 0.0}, VehicleShape{}, 1.0), std::invalid_argument);
  EXPECT_THROW(tiles.unknown_fraction({5000.0, -20.0, 0.0}, VehicleShape{}), std::invalid_argument);
}

/// A box of free cells 0 ≤ x, y < 10 m, 2 m high, only 1 m where x < 5 m.
OccupancyMap partly_measured() {
  PointCloud cloud;
  const double cell_m = 0.5;
  for (double x = 0.25; x < 10.0; x += cell_m) {
    for (double y = 0.25; y < 10.0; y += cell_m) {
      for (double z = 0.25; z < (x < 5.0 ? 1.0 : 2.0); z += cell_m) {
        cloud.points.emplace_back(x, y, z);
      }
    }
  }
  const OccupancyMap occupied = OccupancyMap::build(std::vector{cloud}, {.resolution_m = cell_m});
  std::string bytes = occupied.to_bt();  // turn every occupied leaf (01) into a free one (10)
  for (std::size_t i = bytes.find("data\n") + 5; i < bytes.size(); ++i) {
    unsigned byte = static_cast<unsigned char>(bytes[i]);
    for (unsigned shift = 0; shift < 8; shift += 2) {
      if ((byte >> shift & 3u) == 2u) byte ^= 3u << shift;
    }
    bytes[i] = static_cast<char>(byte);
  }
  return OccupancyMap::parse(bytes, "free.bt");
}

TEST(ClearanceField, UnknownShareIsTheVolumeNeverMeasured) {
  const HeightBand band{0.0, 2.0};
  const OccupancyMap free = partly_measured();
  ASSERT_EQ(free.at({1, 1, 0.25}), CellState::free);
  const ClearanceField field(free, band);
  const VehicleShape box{
      .length_m = 4.0, .width_m = 2.0, .rear_overhang_m = 2.0, .wheelbase_m = 1.0};
  EXPECT_FALSE(field.nearest({5.0, 5.0, 0.0}, box, 50.0));
  EXPECT_EQ(field.unknown_fraction({7.5, 5.0, 0.0}, box), 0.0);
  EXPECT_NEAR(field.unknown_fraction({2.5, 5.0, 0.7}, box), 0.5, 1e-12);
  EXPECT_NEAR(field.unknown_fraction({5.0, 5.0, 0.0}, box), 0.25, 1e-12);
  EXPECT_NEAR(field.unknown_fraction({10.0, 5.0, 0.0}, box), 0.5, 1e-12);
  EXPECT_NEAR(field.unknown_fraction({10.0, 5.0, M_PI / 2}, box), 0.5, 1e-12);
  EXPECT_NEAR(field.unknown_fraction({-50.0, 5.0, 0.3}, box), 1.0, 1e-12);
  // Distances to unknown space: the half-measured columns, and all around.
  const auto to_unknown = [&](const Pose2& pose) {
    return field.nearest(pose, box, 50.0, ObstacleKind::unknown)->distance_m;
  };
  EXPECT_NEAR(to_unknown({7.5, 5.0, 0.0}), 0.5, 1e-9);
  EXPECT_NEAR(to_unknown({7.75, 5.0, 0.0}), 0.25, 1e-9);
  EXPECT_NEAR(to_unknown({7.5, 8.75, 0.0}), 0.25, 1e-9);
  EXPECT_EQ(to_unknown({4.0, 5.0, 0.0}), 0.0);
  EXPECT_EQ(to_unknown({40.0, 5.0, 0.0}), 0.0);
  EXPECT_LE(field.distance_bound_m({9.9, 5.0}, ObstacleKind::unknown), 0.1);
}

/// Area of the part of a convex polygon, counter-clockwise, that lies in a box.
double area_between(std::vector<Eigen::Vector2d> polygon, const Eigen::Array2d& least,
                    const Eigen::Array2d& most) {
  const auto cut = [&](const Eigen::Vector2d& inwards, double at) {
    std::vector<Eigen::Vector2d> left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double in_a = inwards.dot(a) - at, in_b = inwards.dot(b) - at;
      if (in_a >= 0.0) left.push_back(a);
      if ((in_a >= 0.0) != (in_b >= 0.0)) left.push_back(a + in_a / (in_a - in_b) * (b - a));
    }
    polygon = left;
  };
  cut({1, 0}, least.x());
  cut({0, 1}, least.y());
  cut({-1, 0}, -most.x());
  cut({0, -1}, -most.y());
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(ClearanceField, UnknownShareIsThatOfClippedAreas) {
  std::mt19937 random(20261122);
  const OccupancyMap free = partly_measured();
  const ClearanceField field(free, HeightBand{0.0, 2.0});
  const VehicleShape shape{
      .length_m = 3.3, .width_m = 1.4, .rear_overhang_m = 0.7, .wheelbase_m = 2.0};
  std::uniform_real_distribution<double> place(-6.0, 16.0), turn(-4.0, 4.0);
  int none = 0, all = 0;
  for (int round = 0; round < 3000; ++round) {
    const Pose2 pose{place(random), place(random), turn(random)};
    const Quad vehicle = vehicle_quad(pose, shape);
    const std::vector<Eigen::Vector2d> body(vehicle.begin(), vehicle.end());
    const double whole = shape.length_m * shape.width_m;
    const double measured =
        0.5 * area_between(body, {0, 0}, {5, 10}) + area_between(body, {5, 0}, {10, 10});
    const double fraction = field.unknown_fraction(pose, shape);
    ASSERT_NEAR(fraction, 1.0 - measured / whole, 1e-9);
    none += fraction == 0.0;
    all += fraction == 1.0;
  }
  EXPECT_GT(none, 50);
  EXPECT_GT(all, 100);
}

TEST(ClearanceField, UnknownShareOfARotatedVehicleEqualsDenseSampling) {
  std::mt19937 random(3);
  const OccupancyMap occupancy = random_occupancy(random, 0.5, 6.0);
  const ClearanceField field(occupancy, kBand);
  const VehicleShape shape;
  for (int round = 0; round < 10; ++round) {
    const Pose2 pose = random_pose(random, 6.0);
    int unknown = 0;
    const int steps = 400;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const Eigen::Vector2d at =
            pose * Eigen::Vector2d(-shape.rear_overhang_m + shape.length_m * (i + 0.5) / steps,
                                   shape.width_m * ((j + 0.5) / steps - 0.5));
        bool occupied = false;
        for (double z = 0.25; z < 1.5; z += 0.25) {
          occupied = occupied || occupancy.at({at.x(), at.y(), z}) == CellState::occupied;
        }
        unknown += !occupied;
      }
    }
    EXPECT_NEAR(field.unknown_fraction(pose, shape), unknown / double(steps * steps), 3e-3);
  }
}

// As grids its tiles would take 40 GB, one after the other.
TEST(ClearanceField, FarFromAllThatWasMeasuredIsUnknownAndKeepsNoCells) {
  std::mt19937 random(5);
  const OccupancyMap occupancy = scans_between_hits(random, 15.0);
  const ClearanceField field(occupancy, kBand,
                             FieldRegion{.around = {{4000.0, -40.0}, {2e6, 0.0}}});
  const VehicleShape shape;
  for (double x = 10'000.0; x < 1.9e6; x += 1000.0) {
    const Pose2 pose(x, -20.03, 0.3);
    ASSERT_EQ(field.unknown_fraction(pose, shape), 1.0);
    ASSERT_FALSE(field.nearest(pose, shape, 50.0));
    ASSERT_EQ(field.distance_bound_m(pose.position()), field.horizon_m());
    const auto unknown = field.nearest(pose, shape, 50.0, ObstacleKind::unknown);
    ASSERT_TRUE(unknown);
    ASSERT_EQ(unknown->distance_m, 0.0);
    ASSERT_FALSE(field.nearest_measured(geometry::body_at(pose, shape), 20.0));
  }
  EXPECT_LT(field.unknown_fraction(Pose2(5000.0, -20.0, 0.0), shape), 1.0);
}

}  // namespace
}  // namespace roadbed::map
