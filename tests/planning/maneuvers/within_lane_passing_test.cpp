#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roadbed/planning/maneuvers/within_lane_passing.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kCyclist_mps = 4.0, kCyclistWidth_m = 0.6;

struct PassedCyclist {
  bool is_passed = false;
  double beside_m = 1e9;  ///< least distance of the sides while the bodies are beside one another
  std::string reason;     ///< of a cycle behind it
};

/// On a one-way road, with a cyclist 0.5 m from its right edge.
PassedCyclist drive_behind_cyclist(double road_width_m, const std::string& kind = "bicycle") {
  const double d_m = 0.5 - 0.5 * road_width_m;
  planning::Obstacle other{
      .id = "rider", .kind = kind, .length_m = 1.8, .width_m = kCyclistWidth_m, .motion = {}};
  other.motion =
      drive_through({{0.0, {50.0, d_m, 0.0}}, {60.0, {50.0 + 60.0 * kCyclist_mps, d_m, 0}}});
  Scenario scenario;
  scenario.start_speed_mps = 8.0;
  scenario.options.desired_speed_mps = 10.0;
  scenario.duration_s = 25.0;
  World world =
      tests::straight_world({.to_x_m = 460.0, .width_m = road_width_m, .goal_x_m = 400.0}, {other});
  const Drive driven = drive(scenario, world);
  PassedCyclist passed;
  for (const geometry::TrajectoryPoint& row : driven.trajectory.points()) {
    const auto body = geometry::body_at(row.pose(), scenario.vehicle);
    const auto rider = rectangle_at(other, row.t_s);
    const double apart_m = std::abs(body.centre.x() - rider.centre.x());
    passed.is_passed = body.centre.x() > rider.centre.x() + 5.0;
    if (apart_m > body.half_length_m + rider.half_length_m) continue;
    passed.beside_m = std::min(passed.beside_m, geometry::distance_m(body, rider));
  }
  for (const DriveCycle& cycle : driven.cycles) {
    if (cycle.behaviour == planning::Behaviour::follow) passed.reason = cycle.reason;
  }
  return passed;
}

// Beside the cyclist's 0.8 m a vehicle of 1.61 m and 1.5 m between them have to fit: 3.91 m. A
// path ends on a grid of 0.1 m, and the body sways a little as it turns.
TEST(WithinLanePassing, CyclistsArePassedAtAMetreAndAHalfWhereTheLaneHasThatRoom) {
  for (const double width_m : {4.15, 4.5, 5.0, 6.0}) {
    SCOPED_TRACE(testing::Message() << "road of " << width_m << " m");
    const PassedCyclist passed = drive_behind_cyclist(width_m);
    EXPECT_TRUE(passed.is_passed) << passed.reason;
    EXPECT_GE(passed.beside_m, 1.49);
  }
}

TEST(WithinLanePassing, CyclistsAreFollowedWhereTheLaneLacksRoomAndTheReasonSaysHowMuch) {
  for (const double width_m : {3.0, 3.5, 3.8}) {
    SCOPED_TRACE(testing::Message() << "road of " << width_m << " m");
    const PassedCyclist passed = drive_behind_cyclist(width_m);
    EXPECT_FALSE(passed.is_passed);
    EXPECT_EQ(passed.beside_m, 1e9);
    EXPECT_THAT(passed.reason, testing::HasSubstr(fmt::format(
                                   "{:.1f} m of room are missing beside it", 3.91 - width_m)));
  }
}

TEST(WithinLanePassing, OthersNeedOnlyTheClearanceThatIsAskedFor) {
  const PassedCyclist passed = drive_behind_cyclist(3.5, "scooter");
  EXPECT_TRUE(passed.is_passed) << passed.reason;
  EXPECT_GE(passed.beside_m, 0.29);
  EXPECT_LT(passed.beside_m, 1.0);
}

/// A car in the right half of a road 7 m wide, at 3 m/s and an acceleration, seen from 10 s on.
planning::Obstacle slow_car(double x_m, double acceleration_mps2) {
  planning::Obstacle car{.id = "slow", .kind = "car", .motion = {}};
  std::vector<geometry::TrajectoryPoint> points;
  for (double after_s = 0.0; after_s < 1.01; after_s += 0.1) {
    const double way_m = 3.0 * after_s + 0.5 * acceleration_mps2 * after_s * after_s;
    points.push_back({.t_s = 10.0 + after_s,
                      .x_m = x_m + way_m,
                      .y_m = -2.0,
                      .speed_mps = 3.0 + acceleration_mps2 * after_s});
  }
  car.motion = geometry::Trajectory(std::move(points));
  return car;
}

/// What becomes of the first of them, 15 m behind it.
planning::WithinLanePassing behind(std::vector<planning::Obstacle> others) {
  const World world = tests::straight_world({.width_m = 7.0}, std::move(others));
  const Scenario scenario;
  const planning::ViewOnLine view{
      .t_s = 10.0, .at = {.s_m = 30.0, .d_m = 0.0}, .speed_mps = 5.0, .traffic = {world.obstacles}};
  return planning::look_within_lane({.view = view,
                                     .line = world.line,
                                     .vehicle = scenario.vehicle,
                                     .free_mps = 12.0,
                                     .clearance_m = 0.3,
                                     .most_left_m = 3.0,
                                     .most_right_m = 3.0});
}

TEST(WithinLanePassing, NobodyIsPassedWhoBrakesOrQueues) {
  EXPECT_TRUE(behind({slow_car(60.0, 0.0)}).passed);
  EXPECT_TRUE(behind({slow_car(60.0, -0.9)}).passed);
  EXPECT_EQ(behind({slow_car(60.0, -1.1)}).reason, "slow is not passed: it brakes");
  EXPECT_EQ(behind({slow_car(60.0, 0.0), slow_car(79.0, 0.0)}).reason,
            "slow is not passed: it queues");
  EXPECT_TRUE(behind({slow_car(60.0, 0.0), slow_car(80.0, 0.0)}).passed) << "15.5 m between them";
}

}  // namespace
}  // namespace roadbed::tools
