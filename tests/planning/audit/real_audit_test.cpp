#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tests/support/brute_force_distance.h"
#include "roadbed/tests/support/random_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using geometry::VehicleShape;
using map::CellState;
using map::OccupancyCell;
using tests::Quad;

/// A small robot, as it would fit into a building.
constexpr VehicleShape kRobot{
    .length_m = 0.9, .width_m = 0.5, .rear_overhang_m = 0.25, .wheelbase_m = 0.4, .height_m = 0.8};

/// Distances to every occupied box of a height band, one by one.
class EveryBox {
 public:
  EveryBox(const std::vector<OccupancyCell>& cells, const map::HeightBand& band) {
    for (const OccupancyCell& cell : cells) {
      const double low_m = cell.centre_in_source.z() - 0.5 * cell.size_m;
      if (cell.state != CellState::occupied || low_m >= band.to_m - 1e-6) continue;
      if (low_m + cell.size_m <= band.from_m + 1e-6) continue;
      boxes_.push_back({cell.centre_in_source.head<2>(), 0.5 * cell.size_m});
    }
  }

  const Eigen::Vector2d& middle(std::size_t i) const { return boxes_[i % boxes_.size()].middle; }

  double distance_m(const geometry::Pose2& pose) const {
    const auto c = kRobot.corners_in_vehicle();
    const Quad body{pose * c[0], pose * c[1], pose * c[2], pose * c[3]};
    double least_m = std::numeric_limits<double>::infinity();
    for (const auto& [middle, half_m] : boxes_) {
      const double reach_m = least_m + 2.0 + 2.0 * half_m;
      if ((middle - pose.position()).squaredNorm() > reach_m * reach_m) continue;
      least_m = std::min(
          least_m, tests::quad_distance(
                       body, tests::box_quad(middle.array() - half_m, middle.array() + half_m)));
    }
    return least_m;
  }

 private:
  struct Box {
    Eigen::Vector2d middle;
    double half_m;
  };
  std::vector<Box> boxes_;
};

Trajectory drive_near(const Eigen::Vector2d& place, std::mt19937& random) {
  const auto first = tests::random_start(random, place, 3.0, 3.2);
  return tests::random_drive(random, first, {.rows = 2, .turn_rad = 0.8});
}

// Every box is measured at every step, which takes twenty minutes under sanitizers.
constexpr int kAllRounds = 25;
#ifdef __SANITIZE_ADDRESS__
constexpr int kRounds = 8;
#else
constexpr int kRounds = kAllRounds;
#endif

/// Audits of random drives beside what was measured, against a sweep in steps of 2 cm.
void expect_agreement(const std::filesystem::path& file, const map::HeightBand& band) {
  const map::OccupancyMap occupancy = map::OccupancyMap::load(file);
  const auto cells = occupancy.cells();
  const EveryBox every(cells, band);
  std::mt19937 random(79);
  int conflicts = 0, clear = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Trajectory drive = drive_near(every.middle(random()), random);
    const AuditOptions options{.clearance_m = 0.05, .unknown = UnknownPolicy::free};
    const map::ClearanceField field(occupancy, band, audited_region(drive, kRobot, options));
    const AuditReport report = audit_clearance(field, drive, kRobot, options);
    double least_m = std::numeric_limits<double>::infinity();
    constexpr int steps = 150;  // of at most 2 × 1.5 cm
    for (int i = 0; i <= steps; ++i) {
      const double t_s = 2.0 * i / steps;
      const double distance_m = every.distance_m(drive.at(t_s).pose());
      least_m = std::min(least_m, distance_m);
      if (distance_m > 0.0 && distance_m >= options.clearance_m) continue;
      ASSERT_TRUE(std::ranges::any_of(report.conflicts,
                                      [&](const Conflict& conflict) {
                                        return conflict.from_s <= t_s + 1e-9 &&
                                               t_s <= conflict.to_s + 1e-9;
                                      }))
          << file << ", round " << round << ": the conflict at " << t_s << " s is in no stretch";
    }
    ASSERT_LE(report.proven_clearance_m, least_m + 1e-6) << file << ", round " << round;
    ASSERT_NEAR(report.least_clearance_m, std::min(least_m, field.horizon_m()), 0.035)
        << file << ", round " << round;
    const auto certificate = certify(field, band, drive, kRobot, options, report);
    EXPECT_THAT(check_certificate(certificate, cells, occupancy.resolution_m(), drive),
                testing::IsEmpty());
    conflicts += report.verdict == Verdict::conflict;
    clear += report.verdict == Verdict::clear;
  }
  if (kRounds < kAllRounds) return;
  EXPECT_GT(conflicts, 2) << file;
  EXPECT_GT(clear, 2) << file;
}

TEST(RealAudit, ThroughGeb079AgreesWithBruteForce) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_agreement(folder / "occupancy/OctoMap+octomap/geb079.bt", {0.2, 1.0});
}

TEST(RealAudit, ThroughCatecAgreesWithBruteForce) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_agreement(folder / "occupancy/robotics-upo+dll/catec.bt", {0.2, 1.0});
}

}  // namespace
}  // namespace roadbed::planning
