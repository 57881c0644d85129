#include "roadbed/tools/simulation/drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/simulation/metrics.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

using planning::Obstacle;

constexpr double kGoal_m = 200.0;

/// A straight one-way road along the x axis, 260 m long, with the ego at x = 10 m.
World road_of_width(double width_m, std::vector<Obstacle> obstacles) {
  return tests::straight_world({.width_m = width_m, .goal_x_m = kGoal_m}, std::move(obstacles));
}

Obstacle parked(double x_m, double y_m) {
  Obstacle obstacle{.id = "parked", .motion = {}};
  obstacle.motion = drive_through({{0.0, {x_m, y_m, 0.0}}});
  return obstacle;
}

Obstacle driving(double x_m, const std::vector<TimedSpeed>& speeds) {
  Obstacle obstacle{.id = "driving", .motion = {}};
  obstacle.motion = drive_along(
      [x_m](double distance_m) {
        return geometry::Pose2{x_m + distance_m, 0.0, 0.0};
      },
      1e4, speeds, 120.0);
  return obstacle;
}

Scenario scenario_at(double speed_mps) {
  Scenario scenario;
  scenario.start_speed_mps = speed_mps;
  scenario.options.desired_speed_mps = 10.0;
  scenario.duration_s = 60.0;
  return scenario;
}

double least_clearance_m(const Drive& drive) {
  double least = 1e9;
  for (const DriveSample& sample : drive.samples) least = std::min(least, sample.clearance_m);
  return least;
}

bool does(const Drive& drive, planning::Behaviour behaviour) {
  return std::any_of(drive.cycles.begin(), drive.cycles.end(),
                     [&](const DriveCycle& cycle) { return cycle.behaviour == behaviour; });
}

TEST(ClosedLoop, FreeRoadIsDrivenStraightToTheGoal) {
  World world = road_of_width(4.0, {});
  const Drive drive = tools::drive(scenario_at(0.0), world);
  ASSERT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  const geometry::TrajectoryPoint& end = drive.trajectory.points().back();
  EXPECT_NEAR(end.x_m, kGoal_m, 0.3);
  EXPECT_EQ(end.speed_mps, 0.0);
  for (const auto& row : drive.trajectory.points()) {
    EXPECT_NEAR(row.y_m, 0.0, 0.01);
    EXPECT_LE(row.speed_mps, 10.1);
    EXPECT_LE(std::abs(row.acceleration_mps2), 1.9);
  }
  EXPECT_FALSE(does(drive, planning::Behaviour::emergency));
}

TEST(ClosedLoop, RowsObeyTheVehiclesKinematics) {
  World world = road_of_width(9.0, {parked(70.0, -1.0)});
  const Drive drive = tools::drive(scenario_at(8.0), world);
  const auto& rows = drive.trajectory.points();
  ASSERT_EQ(rows.size(), drive.samples.size());
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    const auto &a = rows[i - 1], &b = rows[i];
    const double dt = b.t_s - a.t_s, speed = 0.5 * (a.speed_mps + b.speed_mps);
    EXPECT_NEAR(dt, 0.1, 1e-9);
    EXPECT_NEAR((b.pose().position() - a.pose().position()).norm(), speed * dt, 2e-3);
    EXPECT_NEAR(b.heading_rad - a.heading_rad,
                0.5 * (a.curvature_per_m + b.curvature_per_m) * speed * dt, 2e-4);
    EXPECT_NEAR(b.speed_mps - a.speed_mps, 0.5 * (a.acceleration_mps2 + b.acceleration_mps2) * dt,
                0.01);
    EXPECT_LE(std::abs(b.steering_rad - a.steering_rad), 0.4 * dt + 1e-9);
  }
}

TEST(ClosedLoop, PassesAParkedCarAndComesBack) {
  World world = road_of_width(9.0, {parked(80.0, -0.5)});
  const Drive drive = tools::drive(scenario_at(8.0), world);
  ASSERT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_GT(least_clearance_m(drive), 0.2);
  EXPECT_TRUE(does(drive, planning::Behaviour::pass));
  EXPECT_NEAR(drive.trajectory.points().back().y_m, 0.0, 0.1);
  for (const DriveSample& sample : drive.samples) EXPECT_EQ(sample.off_road_m, 0.0);
}

TEST(ClosedLoop, StopsBehindACarThatLeavesNoWay) {
  World world = road_of_width(4.0, {parked(80.0, 0.0)});
  Scenario scenario = scenario_at(8.0);
  scenario.duration_s = 20.0;
  const Drive drive = tools::drive(scenario, world);
  EXPECT_EQ(drive.verdict.outcome, Outcome::stopped);
  EXPECT_THAT(drive.verdict.text, testing::HasSubstr("before the goal"));
  EXPECT_GT(least_clearance_m(drive), 2.0);
  EXPECT_LT(least_clearance_m(drive), 8.0);
  EXPECT_FALSE(does(drive, planning::Behaviour::emergency));
}

TEST(ClosedLoop, FollowsASlowerCarAtItsHeadway) {
  World world = road_of_width(4.0, {driving(60.0, {{0.0, 4.0}})});
  Scenario scenario = scenario_at(9.0);
  scenario.duration_s = 26.0;
  const Drive drive = tools::drive(scenario, world);
  EXPECT_TRUE(does(drive, planning::Behaviour::follow));
  const DriveCycle& cycle = drive.cycles.at(250);  // at 25 s
  ASSERT_TRUE(cycle.lead);
  EXPECT_NEAR(cycle.lead->gap_m, 1.5 * 4.0 + 5.0, 0.5);
  EXPECT_NEAR(drive.trajectory.at(cycle.t_s).speed_mps, 4.0, 0.1);
}

TEST(ClosedLoop, BrakesHarderThanTheCruiseControlMayOnlyIfItMust) {
  // 8 m ahead at the same speed, and from 0.5 s on the lead brakes at 8 m/s².
  World world = road_of_width(4.0, {driving(24.0, {{0.0, 9.0}, {0.5, 9.0}, {1.6, 0.0}})});
  Scenario scenario = scenario_at(9.0);
  scenario.duration_s = 6.0;
  const Drive drive = tools::drive(scenario, world);
  EXPECT_NE(drive.verdict.outcome, Outcome::collision) << drive.verdict.text;
  EXPECT_TRUE(does(drive, planning::Behaviour::emergency));
  EXPECT_GT(least_clearance_m(drive), 0.3);
  EXPECT_TRUE(std::any_of(drive.events.begin(), drive.events.end(), [](const DriveEvent& event) {
    return event.text.starts_with("emergency: ");
  }));
}

TEST(ClosedLoop, TouchingSomethingEndsTheDrive) {
  // A car appears 1 m ahead of the bumper: it drives into the ego's way at 30 m/s from behind.
  Obstacle rammer{.id = "rammer", .motion = {}};
  rammer.motion = drive_through({{0.0, {-40.0, 0.0, 0.0}}, {2.0, {60.0, 0.0, 0.0}}});
  World world = road_of_width(4.0, {rammer});
  const Drive drive = tools::drive(scenario_at(5.0), world);
  EXPECT_EQ(drive.verdict.outcome, Outcome::collision);
  EXPECT_THAT(drive.verdict.text, testing::HasSubstr("touched rammer"));
  EXPECT_LT(drive.verdict.at_s, 2.0);
  EXPECT_EQ(drive.samples.back().clearance_m, 0.0);
}

TEST(ClosedLoop, SameScenarioSameBytesAndAnotherSeedAnotherDrive) {
  World world = road_of_width(9.0, {parked(80.0, -0.5)});
  Scenario scenario = scenario_at(8.0);
  scenario.duration_s = 8.0;
  scenario.noise = {.gap_m = 0.2,
                    .relative_speed_mps = 0.1,
                    .acceleration_mps2 = 0.05,
                    .position_m = 0.02,
                    .heading_rad = 0.001,
                    .speed_mps = 0.05};
  const auto bytes = [&] { return write_trajectory_csv(tools::drive(scenario, world).trajectory); };
  const std::string first = bytes();
  EXPECT_EQ(first, bytes());
  scenario.seed = 2;
  EXPECT_NE(first, bytes());
}

TEST(ClosedLoop, NoiseIsLivedWith) {
  World world = road_of_width(4.0, {driving(60.0, {{0.0, 4.0}, {20.0, 4.0}, {24.0, 8.0}})});
  Scenario scenario = scenario_at(9.0);
  scenario.noise = {.gap_m = 0.5,
                    .relative_speed_mps = 0.2,
                    .acceleration_mps2 = 0.1,
                    .position_m = 0.05,
                    .heading_rad = 0.002,
                    .speed_mps = 0.1};
  const Drive drive = tools::drive(scenario, world);
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_FALSE(does(drive, planning::Behaviour::emergency));
  for (const auto& row : drive.trajectory.points()) EXPECT_NEAR(row.y_m, 0.0, 0.15);
}

TEST(ClosedLoop, MetricsAgreeWithTheDrive) {
  World world = road_of_width(9.0, {parked(80.0, -0.5)});
  const Scenario scenario = scenario_at(8.0);
  const Drive drive = tools::drive(scenario, world);
  const nlohmann::ordered_json metrics = metrics_of(scenario, world, drive, {});
  EXPECT_EQ(metrics["goal_reached"], true);
  EXPECT_EQ(metrics["collision"], false);
  EXPECT_NEAR(metrics["driven_m"].get<double>(), 190.0, 2.0);
  EXPECT_EQ(metrics["least_clearance_m"].get<double>(), least_clearance_m(drive));
  EXPECT_LE(std::abs(metrics["to_goal_m"].get<double>()), 1.0);
  EXPECT_TRUE(metrics["audit"].is_null());
  double behaviour_s = 0.0;
  for (const auto& [key, seconds] : metrics["behaviour"].items())
    behaviour_s += seconds.get<double>();
  EXPECT_NEAR(behaviour_s, 0.1 * static_cast<double>(drive.cycles.size()), 1e-9);
}

}  // namespace
}  // namespace roadbed::tools
