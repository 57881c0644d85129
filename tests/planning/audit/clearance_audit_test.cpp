#include "roadbed/planning/audit/clearance_audit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tests/support/brute_force_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::Pose2;
using geometry::Trajectory;
using geometry::VehicleShape;
using map::ClearanceField;
using map::OccupancyMap;
using map::PointCloud;
using tests::Quad;

constexpr map::HeightBand kBand{0.2, 1.5};
constexpr double kCell_m = 0.1;

struct World {
  OccupancyMap occupancy;
  std::vector<Quad> boxes;
};

World world_of(const std::vector<Eigen::Vector2d>& hits) {
  PointCloud cloud;
  for (const Eigen::Vector2d& hit : hits) cloud.points.emplace_back(hit.x(), hit.y(), 0.75f);
  World world{OccupancyMap::build(std::vector{cloud}, {.resolution_m = kCell_m}), {}};
  for (const map::OccupancyCell& cell : world.occupancy.cells()) {
    const Eigen::Vector2d centre = cell.centre_in_source.head<2>();
    world.boxes.push_back(
        tests::box_quad(centre.array() - 0.5 * cell.size_m, centre.array() + 0.5 * cell.size_m));
  }
  return world;
}

double distance_at(const World& world, const Trajectory& drive, const VehicleShape& shape,
                   double t_s) {
  const Pose2 pose = drive.at(t_s).pose();
  const auto c = shape.corners_in_vehicle();
  const Quad body{pose * c[0], pose * c[1], pose * c[2], pose * c[3]};
  double least = std::numeric_limits<double>::infinity();
  for (const Quad& box : world.boxes) least = std::min(least, tests::quad_distance(box, body));
  return least;
}

Trajectory straight(const Pose2& from, const Pose2& to) {
  return Trajectory({{.t_s = 0, .x_m = from.x_m, .y_m = from.y_m, .heading_rad = from.heading_rad},
                     {.t_s = 1, .x_m = to.x_m, .y_m = to.y_m, .heading_rad = to.heading_rad}});
}

Trajectory drive_of_few_rows(std::mt19937& random) {
  const auto first = tests::random_start(random, {0.0, 0.0}, 6.0, 3.6);
  return tests::random_drive(random, first,
                             {.rows = 1 + random() % 3, .way_m = 3.0, .turn_rad = 1.2});
}

/// Distances at times so dense that no point of the body moves over `step_m` between two.
struct DenseSweep {
  std::vector<double> t_s, distance_m;
  double least_m = std::numeric_limits<double>::infinity();
};

DenseSweep sweep(const World& world, const Trajectory& drive, const VehicleShape& shape,
                 double step_m) {
  DenseSweep dense;
  const auto& rows = drive.points();
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    const double motion_m =
        std::hypot(rows[i + 1].x_m - rows[i].x_m, rows[i + 1].y_m - rows[i].y_m) +
        5.0 * std::abs(rows[i + 1].heading_rad - rows[i].heading_rad);
    const int steps = 1 + static_cast<int>(motion_m / step_m);
    for (int k = 0; k <= steps; ++k) {
      const double t_s = rows[i].t_s + (rows[i + 1].t_s - rows[i].t_s) * k / steps;
      dense.t_s.push_back(t_s);
      dense.distance_m.push_back(distance_at(world, drive, shape, t_s));
      dense.least_m = std::min(dense.least_m, dense.distance_m.back());
    }
  }
  return dense;
}

TEST(Audit, AgreesWithADenseSweepOverThousandsOfRandomObstaclesAndDrives) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> place(-9.0, 9.0), margin(0.0, 0.6);
  const VehicleShape shape;
  const double step_m = 0.02;
  int conflicts = 0, clear = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<Eigen::Vector2d> hits;
    for (int i = 0; i < 14; ++i) hits.emplace_back(place(random), place(random));
    const World world = world_of(hits);
    const ClearanceField field(world.occupancy, kBand);
    for (int i = 0; i < 10; ++i) {
      const Trajectory drive = drive_of_few_rows(random);
      const AuditOptions options{.clearance_m = i % 2 == 0 ? 0.0 : margin(random),
                                 .unknown = UnknownPolicy::free};
      const AuditReport report = audit_clearance(field, drive, shape, options);
      const DenseSweep dense = sweep(world, drive, shape, step_m);
      ASSERT_LE(report.least_clearance_m, dense.least_m + 0.02);
      ASSERT_GE(report.least_clearance_m, dense.least_m - 0.5 * step_m - 1e-6);
      ASSERT_LE(report.proven_clearance_m, dense.least_m + 1e-6);
      ASSERT_GE(report.proven_clearance_m, report.least_clearance_m - 0.02 - 1e-9);
      ASSERT_NEAR(distance_at(world, drive, shape, report.least_clearance_at_s),
                  report.least_clearance_m, 1e-6);
      const bool too_near = dense.least_m < options.clearance_m || dense.least_m == 0.0;
      if (too_near) {
        ASSERT_EQ(report.verdict, Verdict::conflict);
      }
      if (dense.least_m - 0.5 * step_m > options.clearance_m + 2e-3) {
        ASSERT_EQ(report.verdict, Verdict::clear);
      }
      for (std::size_t k = 0; k < dense.t_s.size(); ++k) {
        if (dense.distance_m[k] > 0.0 && dense.distance_m[k] >= options.clearance_m) continue;
        ASSERT_TRUE(std::any_of(report.conflicts.begin(), report.conflicts.end(),
                                [&](const Conflict& conflict) {
                                  return conflict.from_s <= dense.t_s[k] + 1e-12 &&
                                         dense.t_s[k] <= conflict.to_s + 1e-12;
                                }))
            << "a conflict at " << dense.t_s[k] << " s is in no stretch";
      }
      conflicts += report.verdict == Verdict::conflict;
      clear += report.verdict == Verdict::clear;
    }
  }
  EXPECT_GT(conflicts, 150);
  EXPECT_GT(clear, 150);
}

/// 300 m past poles, with a row every 0.1 m.
Trajectory drive_of_many_rows() {
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 3000; ++i) {
    const double x_m = 0.1 * i;
    rows.push_back({.t_s = 0.01 * i,
                    .x_m = x_m,
                    .y_m = std::sin(x_m / 20.0),
                    .heading_rad = std::atan(std::cos(x_m / 20.0) / 20.0)});
  }
  return Trajectory(std::move(rows));
}

TEST(Audit, PassesOverNoRowOfALongDriveThatMatters) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> along(0.0, 300.0), aside(1.3, 7.0);
  const VehicleShape shape;
  const Trajectory drive = drive_of_many_rows();
  for (int round = 0; round < 6; ++round) {
    std::vector<Eigen::Vector2d> hits;
    for (int i = 0; i < 12; ++i) {
      const double x_m = along(random);
      hits.emplace_back(x_m, std::sin(x_m / 20.0) + (i % 2 == 0 ? 1.0 : -1.0) * aside(random));
    }
    const World world = world_of(hits);
    const ClearanceField field(world.occupancy, kBand);
    const AuditOptions options{.clearance_m = 1.0, .unknown = UnknownPolicy::free};
    const AuditReport report = audit_clearance(field, drive, shape, options);
    const DenseSweep dense = sweep(world, drive, shape, 0.05);
    EXPECT_LE(report.proven_clearance_m, dense.least_m + 1e-6);
    EXPECT_NEAR(report.least_clearance_m, dense.least_m, 0.025);
    for (std::size_t k = 0; k < dense.t_s.size(); ++k) {
      if (dense.distance_m[k] >= options.clearance_m) continue;
      ASSERT_TRUE(std::ranges::any_of(report.conflicts,
                                      [&](const Conflict& conflict) {
                                        return conflict.from_s <= dense.t_s[k] + 1e-12 &&
                                               dense.t_s[k] <= conflict.to_s + 1e-12;
                                      }))
          << "round " << round << ": the conflict at " << dense.t_s[k] << " s is in no stretch";
    }
  }
}

TEST(Audit, EveryConflictIsRealAndItsWitnessStandsWhereItSays) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-7.0, 7.0);
  const VehicleShape shape;
  for (int round = 0; round < 60; ++round) {
    std::vector<Eigen::Vector2d> hits;
    for (int i = 0; i < 10; ++i) hits.emplace_back(place(random), place(random));
    const World world = world_of(hits);
    const ClearanceField field(world.occupancy, kBand);
    const Trajectory drive = drive_of_few_rows(random);
    const AuditReport report =
        audit_clearance(field, drive, shape, {.clearance_m = 0.3, .unknown = UnknownPolicy::free});
    double last_s = -1.0;
    for (const Conflict& conflict : report.conflicts) {
      EXPECT_GT(conflict.from_s, last_s);
      EXPECT_LE(conflict.from_s, conflict.at.t_s);
      EXPECT_GE(conflict.to_s, conflict.at.t_s);
      last_s = conflict.to_s;
      EXPECT_LT(conflict.least_clearance_m, 0.3);
      EXPECT_NEAR(distance_at(world, drive, shape, conflict.at.t_s), conflict.least_clearance_m,
                  1e-6);
      World witness{
          world.occupancy.parse(world.occupancy.to_bt(), "w"),
          {tests::box_quad(conflict.witness.min_in_source, conflict.witness.max_in_source)}};
      EXPECT_NEAR(distance_at(witness, drive, shape, conflict.at.t_s), conflict.least_clearance_m,
                  1e-6);
    }
  }
}

TEST(Audit, SeesATurnOnTheSpotThatBothEndPosesMiss) {
  const World world = world_of({{1.8, 1.8}});  // beside the front left corner at 45°
  const ClearanceField field(world.occupancy, kBand);
  const VehicleShape shape;
  const Trajectory turn = straight({0, 0, 0}, {0, 0, M_PI / 2});
  EXPECT_GT(distance_at(world, turn, shape, 0.0), 0.5);
  EXPECT_GT(distance_at(world, turn, shape, 1.0), 0.5);
  const AuditReport report = audit_clearance(field, turn, shape, {.unknown = UnknownPolicy::free});
  EXPECT_EQ(report.verdict, Verdict::conflict);
  ASSERT_EQ(report.conflicts.size(), 1u);
  EXPECT_GT(report.conflicts[0].from_s, 0.1);
  EXPECT_LT(report.conflicts[0].to_s, 0.9);
}

TEST(Audit, SeesAPoleThatIsPassedBetweenTwoRows) {
  const World world = world_of({{50.0, 0.0}});
  const ClearanceField field(world.occupancy, kBand);
  const AuditReport report = audit_clearance(field, straight({0, 0, 0}, {100, 0, 0}),
                                             VehicleShape{}, {.unknown = UnknownPolicy::free});
  ASSERT_EQ(report.conflicts.size(), 1u);
  const VehicleShape shape;
  EXPECT_NEAR(report.conflicts[0].from_s, (50.0 - shape.front_m()) / 100.0, 5e-4);
  EXPECT_NEAR(report.conflicts[0].to_s, (50.1 + shape.rear_overhang_m) / 100.0, 5e-4);
}

TEST(Audit, InflatingTakesTheMarginOffTheClearance) {
  const World world = world_of({{20.0, 2.05}});
  const ClearanceField field(world.occupancy, kBand);
  const Trajectory drive = straight({12, 0, 0}, {28, 0, 0});
  const double free_m = 2.0 - 0.5 * VehicleShape{}.width_m;
  for (const double inflate_m : {0.0, 0.25, 1.0}) {
    const AuditReport report = audit_clearance(
        field, drive, VehicleShape{}, {.inflate_m = inflate_m, .unknown = UnknownPolicy::free});
    EXPECT_NEAR(report.least_clearance_m, free_m - inflate_m, 0.02);
    EXPECT_EQ(report.verdict, Verdict::clear);
  }
}

TEST(Audit, SaysUndecidedWhereTheClearanceIsMetToAHair) {
  const World world = world_of({{20.0, 2.05}});
  const ClearanceField field(world.occupancy, kBand);
  const double free_m = 2.0 - 0.5 * VehicleShape{}.width_m;
  const AuditReport report =
      audit_clearance(field, straight({12, 0, 0}, {28, 0, 0}), VehicleShape{},
                      {.clearance_m = free_m - 1e-7, .unknown = UnknownPolicy::free});
  EXPECT_EQ(report.verdict, Verdict::undecided);
  EXPECT_FALSE(report.undecided.empty());
}

TEST(Audit, NothingWithinTheHorizonIsALowerBound) {
  const World world = world_of({{5000.0, 0.0}});
  const ClearanceField field(world.occupancy, kBand);
  const AuditReport report = audit_clearance(field, straight({0, 0, 0}, {10, 0, 0}), VehicleShape{},
                                             {.unknown = UnknownPolicy::free});
  EXPECT_TRUE(report.beyond_horizon);
  EXPECT_EQ(report.least_clearance_m, field.horizon_m());
  EXPECT_EQ(report.verdict, Verdict::unknown);  // nothing was measured near
}

/// A street 20 m × 8 m that a scanner saw whole, but for a patch around (10, 2.5).
OccupancyMap scanned_street() {
  std::vector<PointCloud> clouds;
  for (double y = -3.95; y < 4.0; y += 0.1) {
    for (double z = 0.05; z < 1.6; z += 0.1) {
      PointCloud ray;
      const bool patch = std::abs(y - 2.5) < 0.25;
      ray.points = {Eigen::Vector3f(patch ? 9.75f : 20.05f, static_cast<float>(y),
                                    static_cast<float>(patch ? 3.0 : z))};
      ray.sensor_in_source = Eigen::Vector3d(patch ? 9.75 : 0.05, y, patch ? 3.0 : z);
      clouds.push_back(ray);
    }
  }
  return OccupancyMap::build(clouds, {.resolution_m = 0.1});
}

TEST(Audit, NeverCallsADriveThroughUnknownSpaceClearUnlessToldSo) {
  const OccupancyMap street = scanned_street();
  const ClearanceField field(street, kBand);
  const Trajectory known = straight({2.0, -2.0, 0.0}, {15.0, -2.0, 0.0});
  const Trajectory over_patch = straight({2.0, 2.0, 0.0}, {15.0, 2.0, 0.0});
  const Trajectory outside = straight({2.0, 30.0, 0.0}, {15.0, 30.0, 0.0});
  const VehicleShape shape;
  const auto verdict = [&](const Trajectory& drive, UnknownPolicy policy) {
    return audit_clearance(field, drive, shape, {.unknown = policy}).verdict;
  };
  EXPECT_EQ(verdict(known, UnknownPolicy::report), Verdict::clear);
  EXPECT_EQ(verdict(known, UnknownPolicy::occupied), Verdict::clear);
  EXPECT_EQ(verdict(over_patch, UnknownPolicy::report), Verdict::unknown);
  EXPECT_EQ(verdict(over_patch, UnknownPolicy::occupied), Verdict::conflict);
  EXPECT_EQ(verdict(over_patch, UnknownPolicy::free), Verdict::clear);
  EXPECT_EQ(verdict(outside, UnknownPolicy::report), Verdict::unknown);
  EXPECT_EQ(verdict(outside, UnknownPolicy::occupied), Verdict::conflict);

  EXPECT_EQ(audit_clearance(field, known, shape).unknown_fraction, 0.0);
  EXPECT_NEAR(audit_clearance(field, outside, shape).unknown_fraction, 1.0, 1e-9);
  const AuditReport report = audit_clearance(field, over_patch, shape);
  EXPECT_GT(report.unknown_fraction, 0.1);
  EXPECT_FALSE(report.unknown.empty());
  // A wall of hits ends the street at 20 m; margins that are not measured count too.
  EXPECT_EQ(audit_clearance(field, known, shape, {.clearance_m = 1.25}).verdict, Verdict::unknown);
}

TEST(Audit, RefusesBrokenContracts) {
  const World world = world_of({{1, 1}});
  const ClearanceField field(world.occupancy, kBand);
  const Trajectory drive = straight({0, 0, 0}, {1, 0, 0});
  EXPECT_THROW(audit_clearance(field, Trajectory(), VehicleShape{}), std::invalid_argument);
  EXPECT_THROW(audit_clearance(field, drive, VehicleShape{}, {.clearance_m = -1.0}),
               std::invalid_argument);
  EXPECT_THROW(audit_clearance(field, drive, VehicleShape{}, {.clearance_m = NAN}),
               std::invalid_argument);
  EXPECT_THROW(audit_clearance(field, drive, VehicleShape{}, {.inflate_m = -0.1}),
               std::invalid_argument);
  EXPECT_THROW(audit_clearance(field, drive, VehicleShape{}, {.tolerance_m = 0.0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
