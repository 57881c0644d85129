#include "roadbed/planning/speed/drive_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

constexpr double kSearchStep_s = 0.1, kHalfRoad_m = 3.5;
const geometry::VehicleShape kVehicle;

/// Along the x axis, 7 m wide, from −20 m to 120 m.
map::RoadMap road() {
  tests::MadeMap made;
  made.parts.format = "made";
  made.add_lane(made.add_road("1"), "-1", {{-20, kHalfRoad_m}, {120, kHalfRoad_m}},
                {{-20, -kHalfRoad_m}, {120, -kHalfRoad_m}});
  return made.build();
}

/// The vehicle's centre in a box 12 m long and 2.4 m wide, between 2.5 and 3 s.
TimedGoal goal_at(double x_m, double y_m, Window heading_rad = {-0.3, 0.3}) {
  return {.step_s = kSearchStep_s,
          .states = {{.time_s = {2.5, 3.0},
                      .speed_mps = {},
                      .heading_rad = heading_rad,
                      .region_in_source = {map::commonroad::RectangleShape{
                          .length_m = 12.0, .width_m = 2.4, .centre_m = {x_m, y_m}}},
                      .lanes = {}}}};
}

Obstacle box(double x_m, double y_m, double width_m, double speed_mps = 0.0) {
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= (speed_mps == 0.0 ? 0 : 40); ++i) {
    points.push_back({.t_s = kSearchStep_s * i,
                      .x_m = x_m + speed_mps * kSearchStep_s * i,
                      .y_m = y_m,
                      .speed_mps = speed_mps});
  }
  return {.id = "box", .length_m = 4.0, .width_m = width_m, .motion = geometry::Trajectory(points)};
}

std::vector<VehicleState> found(const TimedGoal& goal, const std::vector<Obstacle>& others) {
  const map::RoadMap road_map = road();
  const TrafficBodies bodies({others}, 0.0, 40);
  return search_drive({.vehicle = kVehicle,
                       .road_map = road_map,
                       .bodies = bodies,
                       .goal = goal,
                       .start = {.map_from_vehicle = {0.0, -1.5, 0.0}, .speed_mps = 18.0}});
}

/// 20 m before it at 18 m/s, out to the left and back.
const std::vector<Obstacle> kInTheWay{box(32.0, -2.0, 2.6)};

TEST(DriveSearch, ReachesAGoalBehindWhatStandsAndEndsThereInsideIt) {
  const auto drive = found(goal_at(48.0, 0.5), kInTheWay);
  ASSERT_GE(drive.size(), 26u);
  ASSERT_LE(drive.size(), 31u);
  EXPECT_EQ(drive.front().speed_mps, 18.0);
  const geometry::Rectangle body = geometry::body_at(drive.back().map_from_vehicle, kVehicle);
  EXPECT_LE(std::abs(body.centre.x() - 48.0), 6.0 - 0.25);
  EXPECT_LE(std::abs(body.centre.y() - 0.5), 1.2 - 0.15);
  EXPECT_LE(std::abs(drive.back().map_from_vehicle.heading_rad), 0.3);
}

TEST(DriveSearch, KeepsToTheRoadAndClearAtEveryStep) {
  for (const VehicleState& state : found(goal_at(48.0, 0.5), kInTheWay)) {
    const geometry::Rectangle body = geometry::body_at(state.map_from_vehicle, kVehicle);
    for (const auto& corner : body.corners()) EXPECT_LE(std::abs(corner.y()), kHalfRoad_m - 0.06);
    EXPECT_GT(geometry::distance_m(body, rectangle_at(kInTheWay[0], 0.0)), 0.12);
  }
}

TEST(DriveSearch, DrivesWhatTheVehicleAndItsActuatorCan) {
  const auto drive = found(goal_at(48.0, 0.5), kInTheWay);
  double most_mps2 = 0.0;
  for (std::size_t i = 1; i < drive.size(); ++i) {
    const VehicleState &a = drive[i - 1], &b = drive[i];
    const double speed = 0.5 * (a.speed_mps + b.speed_mps);
    const geometry::Pose2 moved = a.map_from_vehicle.inverse() * b.map_from_vehicle;
    const double tangent = std::tan(0.5 * (a.steering_rad + b.steering_rad));
    EXPECT_NEAR(moved.heading_rad, kSearchStep_s * speed * tangent / kVehicle.wheelbase_m, 1e-3);
    EXPECT_NEAR(moved.x_m, kSearchStep_s * speed, 5e-3);
    EXPECT_NEAR(moved.y_m, 0.5 * moved.x_m * moved.heading_rad, 5e-3);
    EXPECT_LE(std::abs(b.steering_rad - a.steering_rad), kSearchStep_s * 0.4);
    // What the lag of 0.45 s makes of a command: u = a + (a′ − a) / (1 − e^(−t/T)).
    const double command = a.acceleration_mps2 + (b.acceleration_mps2 - a.acceleration_mps2) /
                                                     (1.0 - std::exp(-kSearchStep_s / 0.45));
    EXPECT_GE(command, -8.0 - 1e-9);
    EXPECT_LE(command, 4.0 + 1e-9);
    EXPECT_NEAR(b.speed_mps - a.speed_mps,
                0.5 * kSearchStep_s * (a.acceleration_mps2 + b.acceleration_mps2), 0.02);
    most_mps2 = std::max(most_mps2, speed * std::abs(moved.heading_rad) / kSearchStep_s);
  }
  EXPECT_LE(most_mps2, 3.9);
  EXPECT_GE(most_mps2, 2.0);  // it had to
}

TEST(DriveSearch, IsTheSameEachTime) {
  const auto one = found(goal_at(48.0, 0.5), kInTheWay),
             other = found(goal_at(48.0, 0.5), kInTheWay);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].map_from_vehicle.x_m, other[i].map_from_vehicle.x_m);
    EXPECT_EQ(one[i].map_from_vehicle.y_m, other[i].map_from_vehicle.y_m);
  }
}

TEST(DriveSearch, EndsWithTheHeadingThatIsAskedFor) {
  const auto drive = found(goal_at(46.0, 0.0, {0.15, 0.3}), {});
  ASSERT_FALSE(drive.empty());
  EXPECT_GE(drive.back().map_from_vehicle.heading_rad, 0.15);
  EXPECT_LE(drive.back().map_from_vehicle.heading_rad, 0.3);
}

TEST(DriveSearch, WaitsForWhoIsThereOnlyForAWhile) {
  // Beside a gap that closes: who drives at 8 m/s across all the road ahead is not overtaken.
  const std::vector<Obstacle> slow{box(30.0, 0.0, 7.0, 8.0)};
  EXPECT_TRUE(found(goal_at(60.0, 0.0), slow).empty());
  EXPECT_FALSE(found(goal_at(36.0, -1.5), slow).empty());
}

TEST(DriveSearch, FindsNothingPastAWallOrBeyondReach) {
  EXPECT_TRUE(found(goal_at(48.0, 0.5), {box(32.0, 0.0, 7.0)}).empty());
  EXPECT_TRUE(found(goal_at(95.0, 0.5), {}).empty());
  EXPECT_TRUE(found(TimedGoal{}, {}).empty());
}

}  // namespace
}  // namespace roadbed::planning
