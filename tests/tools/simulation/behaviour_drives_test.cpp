// One drive for each thing that traffic does to the vehicle, known beforehand and not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

/// A straight one-way road of 4 m along the x axis; the ego starts at x = 10 m, the goal is given.
World street(double goal_m, std::vector<planning::Obstacle> others) {
  return tests::straight_world({.to_x_m = 460.0, .goal_x_m = goal_m}, std::move(others));
}

planning::Obstacle scripted(std::string kind, double length_m, double width_m,
                            const std::vector<TimedPose>& poses) {
  return {.id = kind,
          .kind = kind,
          .length_m = length_m,
          .width_m = width_m,
          .motion = drive_through(poses)};
}

struct Kept {
  double clearance_m = 1e9, jerk_mps3 = 0.0, least_speed_mps = 1e9;
};

Kept kept_on(const Drive& drive) {
  Kept kept;
  for (const DriveSample& sample : drive.samples) {
    kept.clearance_m = std::min(kept.clearance_m, sample.clearance_m);
  }
  const auto& rows = drive.trajectory.points();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    kept.least_speed_mps = std::min(kept.least_speed_mps, rows[i].speed_mps);
    if (rows[i].speed_mps < 0.5) continue;  // brakes that hold are let go of at once
    kept.jerk_mps3 = std::max(
        kept.jerk_mps3, std::abs(rows[i].acceleration_mps2 - rows[i - 1].acceleration_mps2) / 0.1);
  }
  return kept;
}

bool brakes_hard(const Drive& drive) {
  return std::ranges::any_of(drive.cycles, [](const DriveCycle& cycle) {
    return cycle.behaviour == planning::Behaviour::emergency;
  });
}

Scenario at_speed(double speed_mps) {
  Scenario scenario;
  scenario.start_speed_mps = speed_mps;
  scenario.options.desired_speed_mps = 10.0;
  scenario.duration_s = 90.0;
  return scenario;
}

/// Both ways of knowing the others.
class BehaviourDrives : public testing::TestWithParam<bool> {
 protected:
  static Drive driven(const Scenario& scenario, World world) {
    return tools::drive(scenario, world, {.predicts = GetParam()});
  }
};
INSTANTIATE_TEST_SUITE_P(KnownOrForeseen, BehaviourDrives, testing::Bool());

TEST_P(BehaviourDrives, StopAndGoTrafficIsFollowedToStandstillAndOn) {
  planning::Obstacle lead{.id = "lead", .motion = {}};
  lead.motion = drive_along(
      [](double distance_m) {
        return geometry::Pose2{40.0 + distance_m, 0.0, 0.0};
      },
      1e4, {{0, 8}, {6, 8}, {11, 0}, {16, 0}, {21, 8}, {26, 8}, {31, 0}, {36, 0}, {41, 9}}, 120.0);
  const Drive drive = driven(at_speed(8.0), street(250.0, {lead}));
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_FALSE(brakes_hard(drive));
  EXPECT_GT(kept_on(drive).clearance_m, 2.0);
  int stops = 0;
  const auto& rows = drive.trajectory.points();
  for (std::size_t i = 1; i + 20 < rows.size(); ++i) {
    stops += rows[i].speed_mps <= 0.05 && rows[i - 1].speed_mps > 0.05 ? 1 : 0;
  }
  EXPECT_GE(stops, 2);
}

TEST_P(BehaviourDrives, CarThatCutsInIsGivenItsRoomWithoutAJerk) {
  const planning::Obstacle other =
      scripted("car", 4.5, 1.8,
               {{0.0, {30, 3.5, 0}}, {3.0, {56, 3.5, 0}}, {5.0, {74, 0, 0}}, {40.0, {389, 0, 0}}});
  const Drive drive = driven(at_speed(10.0), street(300.0, {other}));
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_FALSE(brakes_hard(drive));
  EXPECT_LE(kept_on(drive).jerk_mps3, 4.2);
  EXPECT_GT(kept_on(drive).clearance_m, 1.0);
}

TEST_P(BehaviourDrives, PedestrianWhoCrossesIsWaitedFor) {
  const planning::Obstacle pedestrian =
      scripted("pedestrian", 0.5, 0.5, {{3.0, {70, -5, M_PI_2}}, {11.0, {70, 5, M_PI_2}}});
  const Drive drive = driven(at_speed(10.0), street(150.0, {pedestrian}));
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_GT(kept_on(drive).clearance_m, 0.25);
}

// Who keeps on at 10 m/s is beside the crossing car at x = 100 m after 9 s.
TEST_P(BehaviourDrives, CarThatWillCrossIsBrakedForBeforeItIsOnTheRoad) {
  const planning::Obstacle other =
      scripted("car", 4.5, 1.8, {{0.0, {100, -72, M_PI_2}}, {18.0, {100, 72, M_PI_2}}});
  const Drive drive = driven(at_speed(10.0), street(200.0, {other}));
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_GT(kept_on(drive).clearance_m, 0.5);
  EXPECT_FALSE(brakes_hard(drive));
  const auto braking = std::ranges::find_if(
      drive.samples, [](const DriveSample& sample) { return sample.command_mps2 < -0.5; });
  ASSERT_NE(braking, drive.samples.end());
  EXPECT_LT(braking->t_s, 8.0);  // its front is 4.75 m beside the road's edge then
}

// A parked car 1.8 m wide leaves 3.8 to 5.9 m of a road of 8 m to a vehicle of 1.61 m.
TEST_P(BehaviourDrives, RoomThatIsAskedForIsKept) {
  for (const double clearance_m : {0.2, 0.3, 0.5, 1.0}) {
    for (const double edge_m : {-1.9, -1.1, -0.4, 0.2}) {
      const planning::Obstacle parked{
          .id = "parked", .motion = geometry::Trajectory({{.x_m = 80.0, .y_m = edge_m - 0.9}})};
      Scenario scenario = at_speed(8.0);
      scenario.options.clearance_m = clearance_m;
      scenario.duration_s = 40.0;
      const tests::StraightRoad road{.to_x_m = 200.0, .width_m = 8.0, .goal_x_m = 140.0};
      const Drive drive = driven(scenario, tests::straight_world(road, {parked}));
      SCOPED_TRACE(testing::Message() << clearance_m << " m asked, edge at " << edge_m);
      EXPECT_GE(kept_on(drive).clearance_m, clearance_m - 0.01);
      EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
    }
  }
}

TEST_P(BehaviourDrives, LeadThatLeavesTheRoadLetsTheVehicleSpeedUpAgain) {
  const planning::Obstacle other =
      scripted("car", 4.5, 1.8, {{0.0, {30, 0, 0}}, {8.0, {70, 0, 0}}, {11.0, {84, 7, 0.5}}});
  const Drive drive = driven(at_speed(8.0), street(220.0, {other}));
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  EXPECT_FALSE(brakes_hard(drive));
  EXPECT_LT(kept_on(drive).least_speed_mps, 6.0);
  double fastest = 0.0;
  for (const auto& row : drive.trajectory.points()) fastest = std::max(fastest, row.speed_mps);
  EXPECT_GT(fastest, 9.5);
}

}  // namespace
}  // namespace roadbed::tools
