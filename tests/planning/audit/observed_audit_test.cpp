#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tests/support/part_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using geometry::VehicleShape;
using map::ClearanceField;
using map::OccupancyMap;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kResolution_m = 0.5;

OccupancyMap hits(const std::vector<Eigen::Vector3d>& points) {
  map::PointCloud cloud;
  for (const Eigen::Vector3d& point : points) cloud.points.push_back(point.cast<float>());
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = kResolution_m});
}

Trajectory straight(double from_m, double to_m) {
  return Trajectory({{.t_s = 0.0, .x_m = from_m}, {.t_s = 10.0, .x_m = to_m}});
}

AuditOptions free_space() { return {.unknown = UnknownPolicy::free}; }

VehicleAudit audit_among(const OccupancyMap& occupancy, const Trajectory& drive,
                         const AuditOptions& options, const GroundUnder& ground = {}) {
  const std::vector parts{geometry::body_of(VehicleShape{})};
  const VehicleSurroundings around(occupancy, ground, parts, audited_region(drive, parts, options));
  return audit_vehicle(around, drive, options);
}

TEST(ObservedAudit, OfACloudAtOtherHeightsIsUnknownForThatReason) {
  const OccupancyMap occupancy = hits({{5.0, 3.0, 412.8}, {6.0, 3.0, 413.2}});
  const AuditReport report = audit_among(occupancy, straight(0.0, 5.0), free_space()).whole;
  EXPECT_EQ(report.verdict, Verdict::unknown);
  ASSERT_EQ(report.unobserved.size(), 1u);
  EXPECT_EQ(report.unobserved[0].from_s, 0.0);
  EXPECT_EQ(report.unobserved[0].to_s, 10.0);
  EXPECT_EQ(report.unobserved[0].part, "body");
  EXPECT_THAT(report.unobserved[0].reason, HasSubstr("lies at z 412.50 m to 413.50 m"));
  // Told which ground it is above, the same drive was looked at.
  EXPECT_EQ(
      audit_among(occupancy, straight(0.0, 5.0), free_space(), {.level_m = 412.0}).whole.verdict,
      Verdict::clear);
}

TEST(ObservedAudit, OfACloudElsewhereIsUnknownForThatReason) {
  const OccupancyMap occupancy = hits({{5000.0, 3.0, 0.8}, {5001.0, 3.0, 0.8}});
  const AuditReport report = audit_among(occupancy, straight(0.0, 5.0), free_space()).whole;
  EXPECT_EQ(report.verdict, Verdict::unknown);
  ASSERT_EQ(report.unobserved.size(), 1u);
  EXPECT_THAT(report.unobserved[0].reason, HasSubstr("into one frame"));
}

TEST(ObservedAudit, SaysWhereADriveLeavesWhatWasMeasured) {
  // The rear, 0.83 m behind the axle, is 10 m past the post's cell, 0 to 0.5 m, at x 11.33 m.
  const OccupancyMap occupancy = hits({{0.2, 3.2, 0.8}});
  const VehicleShape shape;
  const double beside_m = 3.0 - 0.5 * shape.width_m;
  const double until_m = 0.5 + std::sqrt(100.0 - beside_m * beside_m) + shape.rear_overhang_m;
  const AuditReport report = audit_among(occupancy, straight(0.0, 40.0), free_space()).whole;
  ASSERT_EQ(report.unobserved.size(), 1u);
  EXPECT_LE(report.unobserved[0].from_s, until_m / 4.0);
  EXPECT_NEAR(report.unobserved[0].from_s, until_m / 4.0, 0.02 / 4.0 + 1e-3);
  EXPECT_EQ(report.unobserved[0].to_s, 10.0);
  EXPECT_THAT(report.unobserved[0].reason, HasSubstr("measure that place"));
}

// Every 2 cm of motion, to every cell that lies in the band.
TEST(ObservedAudit, AgreesWithADenseSweepOverRandomCellsAndDrives) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> place(-40.0, 40.0);
  int observed = 0, unobserved = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 4; ++i) points.emplace_back(place(random), place(random), 0.8);
    points.emplace_back(place(random), place(random), 5.0);  // over the band
    const OccupancyMap occupancy = hits(points);
    const Trajectory drive = tests::random_drive(
        random, tests::random_start(random, {0.0, 0.0}, 30.0, 3.0),
        {.rows = 1 + random() % 4, .step_s = 2.0, .way_m = 15.0, .turn_rad = 1.5});
    const AuditReport report = audit_among(occupancy, drive, free_space()).whole;
    const geometry::BodyPart body = geometry::body_of(VehicleShape{});
    for (double t_s = drive.start_s(); t_s <= drive.end_s(); t_s += 0.01) {
      double least_m = 1e9;
      for (const map::OccupancyCell& cell : occupancy.cells()) {
        if (cell.centre_in_source.z() > 2.0) continue;
        least_m = std::min(least_m, tests::part_to_cell_m(body, 0.0, drive.at(t_s).pose(), cell));
      }
      const bool is_unobserved =
          std::ranges::any_of(report.unobserved, [&](const UnobservedStretch& stretch) {
            return stretch.from_s <= t_s && t_s <= stretch.to_s;
          });
      if (least_m > kObservedWithin_m + 1e-6) {
        EXPECT_TRUE(is_unobserved) << "round " << round << " at " << t_s << ": " << least_m;
        ++unobserved;
      } else if (least_m < kObservedWithin_m - 0.1) {
        EXPECT_FALSE(is_unobserved) << "round " << round << " at " << t_s << ": " << least_m;
        ++observed;
      }
    }
  }
  EXPECT_GT(observed, 1000);
  EXPECT_GT(unobserved, 1000);
}

struct Certified {
  OccupancyMap occupancy;
  Trajectory drive;
  AuditCertificate certificate;

  std::vector<std::string> faults() const { return faults_of(certificate); }
  std::vector<std::string> faults_of(const AuditCertificate& claims) const {
    return check_certificate(claims, occupancy.cells(), kResolution_m, drive);
  }
};

Certified certified(std::vector<Eigen::Vector3d> points, const Trajectory& drive) {
  OccupancyMap occupancy = hits(points);
  const std::vector parts{geometry::body_of(VehicleShape{})};
  const VehicleSurroundings around(occupancy, {}, parts,
                                   audited_region(drive, parts, free_space()));
  const VehicleAudit audit = audit_vehicle(around, drive, free_space());
  AuditCertificate certificate = certify_vehicle(around, drive, free_space(), audit).front();
  return {std::move(occupancy), drive, std::move(certificate)};
}

std::vector<Eigen::Vector3d> row_of_posts() {
  std::vector<Eigen::Vector3d> points;
  for (double x_m = 0.2; x_m < 40.0; x_m += 8.0) points.emplace_back(x_m, 3.2, 0.8);
  return points;
}

TEST(ObservedAudit, CertifiesNoClearanceOfWhatWasNotLookedAt) {
  const Certified far = certified({{0.2, 3.2, 0.8}}, straight(0.0, 40.0));
  EXPECT_THAT(far.faults(), IsEmpty());
  EXPECT_EQ(far.certificate.verdict, Verdict::unknown);
  EXPECT_EQ(far.certificate.certified_clearance_m, 0.0);
  const Certified near = certified(row_of_posts(), straight(0.0, 40.0));
  EXPECT_THAT(near.faults(), IsEmpty());
  EXPECT_EQ(near.certificate.verdict, Verdict::clear);
  EXPECT_GT(near.certificate.certified_clearance_m, 2.0);
}

TEST(ObservedAudit, ACertificateIsRefutedIfItLookedAtLessThanItSays) {
  const Certified honest = certified(row_of_posts(), straight(0.0, 40.0));
  ASSERT_GT(honest.certificate.observed.size(), 2u);
  const auto faults_if = [&](const auto& forge) {
    AuditCertificate forged = honest.certificate;
    forge(forged);
    return honest.faults_of(forged);
  };
  for (std::size_t i = 0; i < honest.certificate.observed.size(); ++i) {
    EXPECT_THAT(faults_if([&](AuditCertificate& claims) {
                  claims.observed.erase(claims.observed.begin() + static_cast<std::ptrdiff_t>(i));
                }),
                Contains(HasSubstr("nothing is said of")));
    EXPECT_THAT(faults_if([&](AuditCertificate& claims) {
                  claims.observed[i].column_in_source.y() += 1.0;
                }),
                Contains(HasSubstr("was not measured")));
    EXPECT_THAT(faults_if([&](AuditCertificate& claims) {
                  claims.observed[i].column_in_source = {8.2 * 4, 3.2};
                  claims.observed[i].from_s = i == 0 ? 0.0 : claims.observed[i - 1].to_s;
                  claims.observed[i].to_s += 5.0;
                }),
                testing::Not(IsEmpty()));
  }
  // Each is said for as long as it holds: 20 cm of motion more are too much.
  EXPECT_THAT(faults_if([](AuditCertificate& claims) {
                claims.observed[0].to_s += 0.05;
                claims.observed[1].from_s += 0.05;
              }),
              Contains(HasSubstr("may be 10.2")));
  EXPECT_THAT(faults_if([](AuditCertificate& claims) {
                claims.observed = {{0.0, 10.0, claims.observed.front().column_in_source}};
              }),
              Contains(HasSubstr("m away")));
}

// Without posts where the drive ends, the honest certificate says unknown; one that says clear all
// the same is found out by what it leaves out.
TEST(ObservedAudit, ACertificateIsRefutedIfItHidesWhatIsUnknown) {
  Certified forged = certified({{0.2, 3.2, 0.8}}, straight(0.0, 40.0));
  forged.certificate.unknown.clear();
  forged.certificate.verdict = Verdict::clear;
  EXPECT_THAT(forged.faults(), Contains(HasSubstr("nothing is said of")));
}

TEST(ObservedAudit, ACertificateIsRefutedIfItsMeasuredShareIsAnother) {
  Certified forged = certified(row_of_posts(), straight(0.0, 40.0));
  const double fraction = forged.certificate.measured_fraction;
  forged.certificate.measured_fraction = fraction + 0.01;
  EXPECT_THAT(forged.faults(), Contains(HasSubstr("measured_share")));
}

TEST(ObservedAudit, AsksForAShareOfTheBodysOwnSpaceWhereToldTo) {
  // Hits below the left half of the body's way measure their columns; all else is unmeasured.
  std::vector<Eigen::Vector3d> points;
  for (double x_m = -9.75; x_m < 50.0; x_m += kResolution_m) {
    for (double y_m = 0.25; y_m < 3.0; y_m += kResolution_m) points.emplace_back(x_m, y_m, 0.8);
  }
  const OccupancyMap occupancy = hits(points);
  AuditOptions options = free_space();
  const Trajectory drive = straight(0.0, 40.0);
  const AuditReport report = audit_among(occupancy, drive, options).whole;
  EXPECT_NEAR(report.unknown_fraction, 0.5, 1e-3);
  const Trajectory beside({{.t_s = 0.0, .y_m = -2.0}, {.t_s = 10.0, .x_m = 40.0, .y_m = -2.0}});
  EXPECT_EQ(audit_among(occupancy, beside, options).whole.verdict, Verdict::clear);
  options.least_measured = 0.01;
  const AuditReport unmeasured = audit_among(occupancy, beside, options).whole;
  EXPECT_EQ(unmeasured.verdict, Verdict::unknown);
  ASSERT_EQ(unmeasured.unknown.size(), 1u);
  EXPECT_EQ(unmeasured.unknown[0].to_s, 10.0);
}

TEST(ObservedAudit, SaysHowDeepAndWideAConflictIs) {
  // A wall across the way, from x 20.0 to 20.5 m, and y -0.5 to 3 m. At the end the front is 2 m
  // past it; the cells beside the body's middle line are out of it at the side, by half its width.
  std::vector<Eigen::Vector3d> points;
  for (double y_m = -0.25; y_m < 3.0; y_m += kResolution_m) points.emplace_back(20.2, y_m, 0.8);
  const VehicleShape shape;
  const double front_m = shape.length_m - shape.rear_overhang_m;
  const Trajectory drive = straight(10.0, 22.0 - front_m);
  const AuditReport report = audit_among(hits(points), drive, free_space()).whole;
  ASSERT_EQ(report.conflicts.size(), 1u);
  const DeepestOverlap& deepest = report.conflicts[0].deepest;
  const double width_m = 0.5 + 0.5 * shape.width_m;
  EXPECT_NEAR(deepest.overlap.area_m2, 0.5 * width_m, 1e-6);
  EXPECT_NEAR(deepest.overlap.depth_m, 0.5 * shape.width_m, 1e-6);
}

}  // namespace
}  // namespace roadbed::planning
