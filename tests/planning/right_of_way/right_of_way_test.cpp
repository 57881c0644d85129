#include "roadbed/planning/right_of_way/right_of_way.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "roadbed/planning/obstacles/foreseen_motion.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kPlace_m = 60.0;  // station on the line, which starts at x = 10 m

/// A car that drives north across the road at x = 75 m and is on it at a time.
planning::Obstacle crossing_at(double t_s) {
  return {.id = "other",
          .motion = drive_through(
              {{0.0, {75.0, -10.0 * t_s, M_PI_2}}, {t_s + 30.0, {75.0, 300.0, M_PI_2}}})};
}

class WaitingAtAPlace : public testing::Test {
 protected:
  WaitingAtAPlace() { scenario_.options.desired_speed_mps = 10.0; }

  void place(planning::StopKind kind) {
    world_.stop_points = {
        {.kind = kind, .s_m = kPlace_m, .clear_s_m = kPlace_m + 10.0, .name = "place 1"}};
    if (kind == planning::StopKind::light) world_.stop_points.front().light = 0;
  }

  /// What is asked with the front bumper `left_m` before the place.
  std::optional<planning::StopConstraint> look(planning::RightOfWay& rules, double t_s,
                                               double left_m, double speed_mps) {
    const planning::PlannedPath path(world_.line,
                                     [](double s_m) { return planning::LateralState{.s_m = s_m}; });
    return rules.look({.t_s = t_s,
                       .s_m = kPlace_m - left_m - scenario_.vehicle.front_m(),
                       .speed_mps = speed_mps,
                       .path = path,
                       .path_s_m = kPlace_m - left_m - scenario_.vehicle.front_m(),
                       .ceiling = ceiling_of(world_.line, scenario_.vehicle, scenario_.options),
                       .traffic = planning::Traffic{world_.obstacles}});
  }

  Scenario scenario_;
  World world_ = tests::straight_world({}, {});
};

TEST_F(WaitingAtAPlace, LightStopsBeforeItsLineUnlessItIsGreen) {
  world_.lights = {{.signals = {"1"},
                    .pointer = "",
                    .phases = {{planning::LightColour::green, 10.0},
                               {planning::LightColour::yellow, 3.0},
                               {planning::LightColour::red, 7.0}}}};
  place(planning::StopKind::light);
  planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
  EXPECT_FALSE(look(rules, 9.9, 30.0, 10.0));
  const auto at_red = look(rules, 14.0, 30.0, 10.0);
  ASSERT_TRUE(at_red);
  EXPECT_NEAR(at_red->s_m, kPlace_m - scenario_.vehicle.front_m() - 0.5, 1e-9);
  EXPECT_THAT(at_red->reason, testing::HasSubstr("place 1 is red, 30.0 m ahead"));
  EXPECT_TRUE(look(rules, 10.1, 30.0, 10.0));
  EXPECT_FALSE(look(rules, 20.1, 30.0, 10.0)) << "the phases begin anew";
}

// 0.9 of a quarter of g stop 10 m/s within 22.65 m; the actuator's lag of 0.45 s takes 4.5 m
// before.
TEST_F(WaitingAtAPlace, LightThatTurnsYellowTooLateIsPassed) {
  world_.lights = {
      {.signals = {"1"}, .pointer = "", .phases = {{planning::LightColour::yellow, 5.0}}}};
  place(planning::StopKind::light);
  planning::RightOfWay in_time(scenario_.vehicle, scenario_.options, world_),
      too_late(scenario_.vehicle, scenario_.options, world_);
  EXPECT_TRUE(look(in_time, 0.0, 27.4, 10.0));
  EXPECT_FALSE(look(too_late, 0.0, 27.1, 10.0));
}

// 20 m/s are stopped comfortably, by 1.5 m/s², within 133 m, and 9 m of the actuator's lag before.
TEST_F(WaitingAtAPlace, IsLookedForAsFarAsAComfortableStopTakes) {
  world_.lights = {
      {.signals = {"1"}, .pointer = "", .phases = {{planning::LightColour::red, 5.0}}}};
  place(planning::StopKind::light);
  const auto stops = [&](double left_m, double speed_mps) {
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    return look(rules, 0.0, left_m, speed_mps).has_value();
  };
  EXPECT_TRUE(stops(140.0, 20.0));
  EXPECT_FALSE(stops(145.0, 20.0));
  EXPECT_TRUE(stops(79.0, 5.0));
  EXPECT_FALSE(stops(81.0, 5.0));
}

TEST_F(WaitingAtAPlace, HaltOnceGivenStaysWithItsDeceleration) {
  world_.lights = {
      {.signals = {"1"}, .pointer = "", .phases = {{planning::LightColour::yellow, 5.0}}}};
  place(planning::StopKind::light);
  planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
  const auto first = look(rules, 0.0, 30.0, 10.0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->deceleration_mps2, 100.0 / (2.0 * (30.0 - 0.5 - 4.5)), 1e-9);
  const auto later = look(rules, 0.1, 16.0, 10.0);  // nobody who came from there would stop
  ASSERT_TRUE(later);
  EXPECT_EQ(later->deceleration_mps2, first->deceleration_mps2);
}

TEST_F(WaitingAtAPlace, EveryLightOfALineHasToBeGreen) {
  world_.lights = {
      {.signals = {"1"}, .pointer = "", .phases = {{planning::LightColour::green, 5.0}}},
      {.signals = {"2"},
       .pointer = "",
       .phases = {{planning::LightColour::red, 1.0}, {planning::LightColour::green, 4.0}}}};
  place(planning::StopKind::light);
  for (const std::size_t first : {0U, 1U}) {
    world_.stop_points.resize(1);
    world_.stop_points.push_back(world_.stop_points.front());
    world_.stop_points[0].light = first;
    world_.stop_points[1].light = 1 - first;
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    EXPECT_TRUE(look(rules, 0.5, 40.0, 10.0)) << first;
    EXPECT_FALSE(look(rules, 1.5, 30.0, 10.0)) << first;
  }
}

/// A car at 10 m/s that is beside the line, and `behind_m` behind the vehicle's rear axle when its
/// front bumper is 20 m before the place; from 2 s on it drives on the line.
planning::Obstacle coming_from_behind(double behind_m, double beside_m, double rear_axle_s_m) {
  const double x_m = 10.0 + rear_axle_s_m - behind_m;
  return {.id = "other",
          .motion = drive_through({{0.0, {x_m, beside_m, 0.0}},
                                   {2.0, {x_m + 20.0, 0.0, 0.0}},
                                   {30.0, {x_m + 300.0, 0.0, 0.0}}})};
}

TEST_F(WaitingAtAPlace, WhoFollowsIsNotWaitedForButWhoComesFromTheNextLaneIs) {
  place(planning::StopKind::give_way);
  const double s_m = kPlace_m - 20.0 - scenario_.vehicle.front_m();
  for (const auto& [beside_m, must_wait] : {std::pair{0.0, false}, {0.8, false}, {3.5, true}}) {
    world_.obstacles = {coming_from_behind(14.0, beside_m, s_m)};
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    EXPECT_EQ(look(rules, 0.0, 20.0, 8.0).has_value(), must_wait) << beside_m;
  }
}

TEST_F(WaitingAtAPlace, LightBehindTheVehicleIsOver) {
  world_.lights = {
      {.signals = {"1"}, .pointer = "", .phases = {{planning::LightColour::red, 5.0}}}};
  place(planning::StopKind::light);
  planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
  EXPECT_TRUE(look(rules, 0.0, 0.2, 0.0));
  EXPECT_FALSE(look(rules, 0.1, -0.4, 1.0));
}

TEST_F(WaitingAtAPlace, StopSignAsksForAStandstillOnce) {
  place(planning::StopKind::stop_sign);
  planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
  EXPECT_TRUE(look(rules, 0.0, 20.0, 5.0));
  EXPECT_TRUE(look(rules, 4.0, 1.0, 0.5));
  EXPECT_FALSE(look(rules, 6.0, 0.6, 0.0));
  EXPECT_FALSE(look(rules, 7.0, 0.3, 1.0));
}

TEST_F(WaitingAtAPlace, GapIsTakenOnlyIfNobodyComesWithinIt) {
  place(planning::StopKind::give_way);
  // From rest at the line the body is on the crossing car's way from about 2.4 to 3.9 s later.
  for (const auto& [at_s, must_wait] :
       {std::pair{0.3, false}, {3.0, true}, {5.5, true}, {12.0, false}}) {
    world_.obstacles = {crossing_at(at_s)};
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    EXPECT_EQ(look(rules, 0.0, 0.5, 0.0).has_value(), must_wait) << at_s;
  }
}

// Speeding up by 2.5 m/s² the body is there from about 1.5 s on, less than 1 s after who crosses
// then.
TEST_F(WaitingAtAPlace, GapIsTakenOnlyIfItIsGoodHoweverTheVehicleSpeedsUp) {
  place(planning::StopKind::give_way);
  world_.obstacles = {crossing_at(0.8)};
  for (const auto& [most_mps2, must_wait] : {std::pair{1.0, false}, {2.5, true}}) {
    scenario_.options.comfort_acceleration_mps2 = most_mps2;
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    EXPECT_EQ(look(rules, 0.0, 0.5, 0.0).has_value(), must_wait) << most_mps2;
  }
}

// At 4 m/s, and by 2 m/s² faster for a second, the other one is at the crossing after 7 s, when the
// vehicle has been gone for 3; speeding up for 4 s, after 4.8 s.
TEST_F(WaitingAtAPlace, GapIsTakenOnlyIfWhoSpeedsUpMayGoOn) {
  place(planning::StopKind::give_way);
  const auto car = [](double acceleration_mps2, double way_m) {
    return planning::Obstacle{
        .id = "other",
        .motion = planning::foreseen_motion({.pose = {75.0, -way_m, M_PI_2},
                                             .speed_mps = 4.0,
                                             .acceleration_mps2 = acceleration_mps2})};
  };
  const auto waits = [&](const planning::Obstacle& other, bool is_foreseen) {
    world_.obstacles = {other};
    world_.others_within.reset();
    if (is_foreseen) world_.others_within.emplace();
    planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
    return look(rules, 0.0, 0.5, 0.0).has_value();
  };
  EXPECT_TRUE(waits(car(2.0, 41.0), true));
  EXPECT_FALSE(waits(car(2.0, 41.0), false)) << "it is known what it will do";
  EXPECT_FALSE(waits(car(0.0, 41.0), true));
}

TEST_F(WaitingAtAPlace, WhoIsMetIsNamed) {
  place(planning::StopKind::turn);
  world_.obstacles = {crossing_at(3.0)};
  planning::RightOfWay rules(scenario_.vehicle, scenario_.options, world_);
  const auto halt = look(rules, 0.0, 0.5, 0.0);
  ASSERT_TRUE(halt);
  EXPECT_THAT(halt->reason, testing::StartsWith("place 1: car other would be met in "));
}

}  // namespace
}  // namespace roadbed::tools
