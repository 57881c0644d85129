#include "roadbed/planning/audit/audit_drive.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

map::OccupancyMap posts_around(std::mt19937& random) {
  std::uniform_real_distribution<float> place(-9.0f, 9.0f), height(0.0f, 2.0f);
  map::PointCloud cloud;
  for (int i = 0; i < 30; ++i) {
    cloud.points.emplace_back(place(random), place(random), height(random));
  }
  return map::OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
}

geometry::Trajectory short_drive(std::mt19937& random) {
  const auto first = tests::random_start(random, {0.0, 0.0}, 6.0, 3.6);
  return tests::random_drive(random, first, {.rows = 3, .way_m = 3.0, .turn_rad = 1.2});
}

void expect_same(const AuditReport& a, const AuditReport& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.least_clearance_m, b.least_clearance_m);
  EXPECT_EQ(a.proven_clearance_m, b.proven_clearance_m);
  EXPECT_EQ(a.unknown_fraction, b.unknown_fraction);
  EXPECT_EQ(a.conflicts.size(), b.conflicts.size());
}

TEST(AuditDrive, IsTheAuditOfTheVehicleAboveItsGroundAndItsCertificatesHold) {
  std::mt19937 random(12);
  for (int round = 0; round < 10; ++round) {
    const map::OccupancyMap occupancy = posts_around(random);
    const geometry::Trajectory drive = short_drive(random);
    const AuditQuestion question{.parts = {geometry::body_of({})},
                                 .ground = {.level_m = 0.1 * round},
                                 .options = {.clearance_m = 0.05 * round},
                                 .certifies = true};
    const DriveAudit audit = audit_drive(occupancy, drive, question);
    const VehicleSurroundings around(occupancy, {.level_m = 0.1 * round}, question.parts,
                                     audited_region(drive, question.parts, question.options));
    expect_same(audit.report, audit_vehicle(around, drive, question.options).whole);
    ASSERT_EQ(audit.certificates.size(), 1u);
    EXPECT_TRUE(check_certificate(audit.certificates[0], occupancy.cells(), 0.1, drive).empty());
  }
}

TEST(AuditDrive, WithinAFieldIsTheAuditOfItsRectangle) {
  std::mt19937 random(13);
  for (int round = 0; round < 10; ++round) {
    const map::OccupancyMap occupancy = posts_around(random);
    const auto field = std::make_shared<const map::ClearanceField>(occupancy, map::HeightBand{});
    const geometry::Trajectory drive = short_drive(random);
    const DriveAudit audit = audit_drive(field, drive, {.parts = {geometry::body_of({})}});
    expect_same(audit.report, audit_clearance(*field, drive, geometry::VehicleShape{}));
    EXPECT_TRUE(audit.certificates.empty());
  }
}

TEST(AuditDrive, TellsTheGroundBeforeItGoesOn) {
  std::mt19937 random(14);
  const map::OccupancyMap occupancy = posts_around(random);
  double told_m = 0.0;
  audit_drive(occupancy, short_drive(random),
              {.parts = {geometry::body_of({})}, .ground = {.level_m = 1.5}},
              [&](const GroundUnder& ground) { told_m = ground.level_m; });
  EXPECT_EQ(told_m, 1.5);
}

}  // namespace
}  // namespace roadbed::planning
