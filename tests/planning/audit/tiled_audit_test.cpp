#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"

namespace roadbed::planning {
namespace {

constexpr map::HeightBand kHeights{0.2, 1.5};

map::OccupancyMap random_surroundings(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-14.0, 14.0), height(0.0, 1.7);
  std::vector<map::PointCloud> clouds;
  for (int scan = 0; scan < 5; ++scan) {
    map::PointCloud cloud;
    cloud.sensor_in_source = Eigen::Vector3d(place(random), place(random), height(random));
    for (int i = 0; i < 5; ++i) {
      cloud.points.push_back(
          Eigen::Vector3d(place(random), place(random), height(random)).cast<float>());
    }
    clouds.push_back(cloud);
  }
  return map::OccupancyMap::build(clouds, {.resolution_m = 0.1});
}

geometry::Trajectory random_way(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-10.0, 10.0), turn(-0.4, 0.4), way(0.0, 1.5);
  std::vector<geometry::TrajectoryPoint> rows{
      {.x_m = place(random), .y_m = place(random), .heading_rad = 8.0 * turn(random)}};
  for (int i = 0; i < 15; ++i) {
    geometry::TrajectoryPoint next = rows.back();
    next.t_s += 0.5;
    next.heading_rad += turn(random);
    const double way_m = way(random);
    next.x_m += way_m * std::cos(next.heading_rad);
    next.y_m += way_m * std::sin(next.heading_rad);
    rows.push_back(next);
  }
  return geometry::Trajectory(std::move(rows));
}

void expect_equal(const std::vector<Stretch>& a, const std::vector<Stretch>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].from_s, b[i].from_s);
    EXPECT_EQ(a[i].to_s, b[i].to_s);
  }
}

void expect_equal(const std::vector<Conflict>& a, const std::vector<Conflict>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].from_s, b[i].from_s);
    EXPECT_EQ(a[i].to_s, b[i].to_s);
    EXPECT_EQ(a[i].least_clearance_m, b[i].least_clearance_m);
    EXPECT_EQ(a[i].at.t_s, b[i].at.t_s);
    EXPECT_EQ(a[i].witness.min_in_source, b[i].witness.min_in_source);
  }
}

void expect_equal(const std::vector<ProvenSpan>& a, const std::vector<ProvenSpan>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].segment, b[i].segment);
    EXPECT_EQ(a[i].from, b[i].from);
    EXPECT_EQ(a[i].to, b[i].to);
    EXPECT_EQ(a[i].at_least_m, b[i].at_least_m);
  }
}

void expect_equal(const AuditReport& a, const AuditReport& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.least_clearance_m, b.least_clearance_m);
  EXPECT_EQ(a.proven_clearance_m, b.proven_clearance_m);
  EXPECT_EQ(a.least_clearance_at_s, b.least_clearance_at_s);
  ASSERT_EQ(a.witness.has_value(), b.witness.has_value());
  if (a.witness) {
    EXPECT_EQ(a.witness->min_in_source, b.witness->min_in_source);
  }
  EXPECT_EQ(a.unknown_fraction, b.unknown_fraction);
  expect_equal(a.conflicts, b.conflicts);
  expect_equal(a.unknown, b.unknown);
  expect_equal(a.undecided, b.undecided);
  ASSERT_EQ(a.profile.size(), b.profile.size());
  for (std::size_t i = 0; i < a.profile.size(); ++i) {
    EXPECT_EQ(a.profile[i].clearance_m, b.profile[i].clearance_m);
  }
}

TEST(TiledAudit, EqualsTheAuditOverTheWholeBitForBitForAnySideOfTiles) {
  std::mt19937 random(20261122);
  const geometry::VehicleShape vehicle;
  int verdicts[4] = {};
  for (int round = 0; round < 30; ++round) {
    const map::OccupancyMap occupancy = random_surroundings(random);
    const geometry::Trajectory drive = random_way(random);
    const AuditOptions options{.clearance_m = round % 3 * 0.3,
                               .inflate_m = round % 2 * 0.2,
                               .unknown = static_cast<UnknownPolicy>(round % 3)};
    map::FieldRegion region = audited_region(drive, vehicle, options);
    region.horizon_m = 5.0;
    const map::ClearanceField whole(occupancy, kHeights, region);
    const AuditReport expected = audit_clearance(whole, drive, vehicle, options);
    const AuditCertificate proof = certify(whole, kHeights, drive, vehicle, options, expected);
    for (const double tile_m : {1.3, 7.0, 33.0}) {
      region.tile_m = tile_m;
      const map::ClearanceField tiles(occupancy, kHeights, region);
      const AuditReport report = audit_clearance(tiles, drive, vehicle, options);
      expect_equal(report, expected);
      const AuditCertificate same = certify(tiles, kHeights, drive, vehicle, options, report);
      EXPECT_EQ(same.certified_clearance_m, proof.certified_clearance_m);
      expect_equal(same.from_occupied, proof.from_occupied);
      expect_equal(same.from_unknown, proof.from_unknown);
      if (HasFailure()) return;
    }
    // So small a part of the memory that there is one tile at a time.
    region.tile_m = 0.0;
    region.most_cells = 1;
    expect_equal(
        audit_clearance(map::ClearanceField(occupancy, kHeights, region), drive, vehicle, options),
        expected);
    if (HasFailure()) return;
    EXPECT_TRUE(check_certificate(proof, occupancy.cells(), 0.1, drive).empty());
    ++verdicts[static_cast<std::size_t>(expected.verdict)];
  }
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::clear)], 1);
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::conflict)], 3);
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::unknown)], 1);
}

TEST(TiledAudit, OfALongDriveThroughOneTileAtATimeEqualsThatOfTheWhole) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(0.0, 400.0), beside(1.5, 4.0);
  map::PointCloud cloud;
  for (int i = 0; i < 300; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    cloud.points.push_back(
        Eigen::Vector3d(along(random), side * beside(random), 0.75).cast<float>());
  }
  const auto occupancy = map::OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 4000; ++i) {
    rows.push_back({.t_s = 0.01 * i, .x_m = 0.1 * i, .y_m = 0.3 * std::sin(0.02 * i)});
  }
  const geometry::Trajectory drive(rows);
  const geometry::VehicleShape vehicle;
  const AuditOptions options{.unknown = UnknownPolicy::free};
  map::FieldRegion region = audited_region(drive, vehicle, options);
  const map::ClearanceField whole(occupancy, kHeights, region);
  region.tile_m = 25.0;
  const map::ClearanceField tiles(occupancy, kHeights, region);
  expect_equal(audit_clearance(tiles, drive, vehicle, options),
               audit_clearance(whole, drive, vehicle, options));
}

}  // namespace
}  // namespace roadbed::planning
