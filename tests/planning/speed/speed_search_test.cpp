#include "roadbed/planning/speed/speed_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/control/lower_controller.h"
#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/tests/support/straight_profile.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kWanted_mps = 12.0;

World world_with(std::vector<planning::Obstacle> obstacles) {
  return tests::straight_world(
      {.from_x_m = -50.0, .to_x_m = 200.0, .width_m = 10.0, .start_x_m = 0.0, .goal_x_m = 190.0},
      std::move(obstacles));
}

planning::Obstacle driving(double x_m, double speed_mps) {
  planning::Obstacle obstacle{.id = "other", .motion = {}};
  obstacle.motion = drive_through({{0.0, {x_m, 0.0, 0.0}}, {20.0, {x_m + 20.0 * speed_mps, 0, 0}}});
  return obstacle;
}

struct Case {
  double speed_mps = 10.0;
  double horizon_s = 5.0;
  std::vector<planning::GoalAhead> goals = {};
  bool goal_is_off_path = false;
  std::vector<planning::Obstacle> obstacles = {};
  planning::SpeedSearchOptions options = {};
};

planning::SpeedSearchAnswer answer(const Case& asked) {
  const World world = world_with(asked.obstacles);
  const planning::PathProfile way = tests::straight_profile(kWanted_mps);
  const planning::StGraph occupancy(way, planning::Traffic{world.obstacles}, 0.0, 120, 0.3);
  return search_speed({.profile = way,
                       .occupancy = occupancy,
                       .speed_mps = asked.speed_mps,
                       .horizon_s = asked.horizon_s,
                       .end_m = 140.0,
                       .goals = asked.goals,
                       .goal_is_off_path = asked.goal_is_off_path},
                      asked.options);
}

TEST(SpeedSearch, FreeWayIsDrivenAtTheWantedSpeed) {
  const planning::SpeedSearchAnswer found = answer({.speed_mps = kWanted_mps});
  ASSERT_TRUE(found.is_free);
  for (const planning::SpeedState& state : found.plan)
    EXPECT_NEAR(state.speed_mps, kWanted_mps, 0.5);
}

TEST(SpeedSearch, PlanIsWhatTheActuatorMakesOfItsCommands) {
  const planning::SpeedSearchAnswer found =
      answer({.speed_mps = 4.0, .obstacles = {driving(30.0, 5.0)}});
  ASSERT_GT(found.plan.size(), 3u);
  constexpr double step_s = 1e-3;
  double speed = 4.0, acceleration = 0.0, ahead = 0.0;
  for (std::size_t i = 1; i < found.plan.size(); ++i) {
    const int steps =
        static_cast<int>(std::lround((found.plan[i].t_s - found.plan[i - 1].t_s) / step_s));
    for (int k = 0; k < steps; ++k) {
      const double before = speed;
      acceleration = control::actuate(acceleration, found.plan[i].command_mps2, step_s);
      speed = std::max(0.0, speed + acceleration * step_s);
      ahead += 0.5 * (before + speed) * step_s;
    }
    EXPECT_NEAR(found.plan[i].speed_mps, speed, 0.01);
    EXPECT_NEAR(found.plan[i].ahead_m, ahead, 0.02);
  }
}

TEST(SpeedSearch, SlowerCarAheadIsNotTouched) {
  const planning::Obstacle other = driving(25.0, 5.0);
  const planning::SpeedSearchAnswer found = answer({.obstacles = {other}});
  ASSERT_TRUE(found.is_free);
  for (const planning::SpeedState& state : found.plan) {
    const double rear = 25.0 + 5.0 * state.t_s - 2.25;
    EXPECT_LT(state.ahead_m + geometry::VehicleShape{}.front_m() + 0.3, rear) << state.t_s;
  }
}

TEST(SpeedSearch, FasterCarFromBehindIsMadeRoomFor) {
  // 12 m/s from behind, at 8 m/s own speed: the plan has to speed up, as the other does not brake.
  const planning::SpeedSearchAnswer found =
      answer({.speed_mps = 8.0, .obstacles = {driving(-14.0, 12.0)}});
  ASSERT_TRUE(found.is_free);
  for (const planning::SpeedState& state : found.plan) {
    EXPECT_GT(state.ahead_m - geometry::VehicleShape{}.rear_overhang_m - 0.3,
              -14.0 + 12.0 * state.t_s + 2.25)
        << state.t_s;
  }
}

TEST(SpeedSearch, WallTooNearIsNotFreeAndSaysUntilWhen) {
  const planning::SpeedSearchAnswer found = answer({.obstacles = {driving(14.0, 0.0)}});
  EXPECT_FALSE(found.is_free);
  EXPECT_GT(found.free_until_s, 0.0);
  EXPECT_LT(found.free_until_s, 2.0);
  EXPECT_TRUE(answer({.obstacles = {driving(24.0, 0.0)}, .options = {.least_mps2 = -8.0}}).is_free);
}

TEST(SpeedSearch, GoalInTimeIsMetByWaitingOrHurrying) {
  for (const double wanted_ahead : {30.0, 55.0}) {
    const planning::GoalAhead goal{
        .time_s = {4.9, 5.0}, .speed_mps = {}, .ahead_m = {wanted_ahead - 2.5, wanted_ahead + 2.5}};
    const planning::SpeedSearchAnswer found = answer({.horizon_s = 6.5, .goals = {goal}});
    ASSERT_TRUE(found.reaches_goal) << wanted_ahead;
    EXPECT_FALSE(found.misses_goal);
  }
}

TEST(SpeedSearch, GoalOutOfReachIsMissedAndSaid) {
  const planning::GoalAhead goal{.time_s = {2.0, 2.0}, .speed_mps = {}, .ahead_m = {60.0, 70.0}};
  const planning::SpeedSearchAnswer found = answer({.goals = {goal}});
  EXPECT_TRUE(found.is_free);
  EXPECT_TRUE(found.misses_goal);
  EXPECT_FALSE(found.reaches_goal);
}

/// Distance of a plan at a time, between its states.
double ahead_at(const planning::SpeedSearchAnswer& found, double t_s) {
  for (std::size_t i = 1; i < found.plan.size(); ++i) {
    const planning::SpeedState &a = found.plan[i - 1], &b = found.plan[i];
    if (b.t_s < t_s) continue;
    return a.ahead_m + (b.ahead_m - a.ahead_m) * (t_s - a.t_s) / (b.t_s - a.t_s);
  }
  return 1e9;
}

TEST(SpeedSearch, GoalCountsAtItsTimeStepsOnly) {
  // Of 2.0 to 3.4 s only 2.5 s is a time step: at 10 m/s it would be there at 2.25 s.
  const planning::GoalAhead goal{.time_s = {2.0, 3.4},
                                 .speed_mps = {},
                                 .ahead_m = {22.0, 23.0},
                                 .step_s = 1.0,
                                 .a_step_s = -0.5};
  const planning::SpeedSearchAnswer found = answer({.goals = {goal}});
  ASSERT_TRUE(found.reaches_goal);
  EXPECT_NEAR(ahead_at(found, 2.5), 22.5, 0.7);
  planning::GoalAhead never = goal;
  never.time_s = {2.6, 3.4};
  EXPECT_FALSE(answer({.goals = {never}}).reaches_goal);
}

TEST(SpeedSearch, GoalThatIsNotOnThePathIsMissedByEverySpeed) {
  const planning::GoalAhead beside{.time_s = {4.9, 5.0}, .speed_mps = {}, .ahead_m = {40, 60}};
  for (const auto& goals : {std::vector{beside}, std::vector<planning::GoalAhead>{}}) {
    const planning::SpeedSearchAnswer off = answer({.goals = goals, .goal_is_off_path = true});
    EXPECT_TRUE(off.is_free);
    EXPECT_TRUE(off.misses_goal);
    EXPECT_FALSE(off.reaches_goal);
    EXPECT_NEAR(off.cost - answer({.goals = goals}).cost, 40.0, 1e-9);
  }
}

TEST(SpeedSearch, StopsBeforeTheWaysEnd) {
  const planning::SpeedSearchAnswer found = answer({.speed_mps = 15.0, .horizon_s = 12.0});
  ASSERT_TRUE(found.is_free);
  EXPECT_LE(found.plan.back().ahead_m, 140.0);
}

}  // namespace
}  // namespace roadbed::tools
