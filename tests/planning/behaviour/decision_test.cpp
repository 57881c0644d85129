#include "roadbed/planning/behaviour/decision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "roadbed/control/cruise_design.h"

namespace roadbed::tools {
namespace {

const planning::SpeedCeiling kTen({10.0, 10.0}, 1000.0, 1.5);

planning::SpeedAnswer ask(const planning::SpeedQuestion& question) {
  return choose_speed(question, {});
}

planning::SpeedQuestion free_road(double speed_mps) {
  return {.ceiling = kTen,
          .goal_s_m = 1000.0,
          .speed_mps = speed_mps,
          .lead = {},
          .lead_name = {},
          .path_left_m = {}};
}

TEST(Decision, FreeRoadIsDrivenAtTheCeiling) {
  const planning::SpeedAnswer answer = ask(free_road(9.5));
  EXPECT_EQ(answer.behaviour, planning::Behaviour::cruise);
  EXPECT_EQ(answer.set.speed_mps, 10.0);
  EXPECT_EQ(answer.set.acceleration_mps2, 0.0);
  EXPECT_FALSE(answer.hold);
}

TEST(Decision, SetSpeedStaysNearTheSpeedSoThatSpeedingUpIsComfortable) {
  EXPECT_EQ(ask(free_road(2.0)).set.speed_mps, 2.0 + 1.5 * 1.5);
}

TEST(Decision, CreepsWhereSomebodyHiddenMayCome) {
  planning::SpeedQuestion question = free_road(1.5);
  question.creep_mps = 2.0;
  const planning::SpeedAnswer answer = ask(question);
  EXPECT_EQ(answer.behaviour, planning::Behaviour::yield);
  EXPECT_EQ(answer.set.speed_mps, 2.0);
}

TEST(Decision, NamesWhereSomebodyMayStepOut) {
  const std::array<planning::HiddenWalker, 2> walkers{{{30.0, 1.0, 2.8}, {40.0, 2.0, 7.0}}};
  planning::SpeedQuestion question = free_road(9.5);
  question.walkers = walkers;
  const planning::SpeedAnswer answer = ask(question);
  EXPECT_NEAR(answer.set.speed_mps, std::sqrt(2.8 * 2.8 + 2.0 * 1.5 * 30.0), 1e-12);
  EXPECT_EQ(answer.reason,
            "at most 2.8 m/s 30 m ahead, where somebody hidden may step out 1.0 m beside the way");
}

TEST(Decision, StopsAtTheGoalAndHoldsThere) {
  planning::SpeedQuestion question = free_road(7.0);
  question.s_m = 980.0;
  EXPECT_EQ(ask(question).behaviour, planning::Behaviour::stop);
  EXPECT_NEAR(ask(question).set.acceleration_mps2, -1.5, 1e-12);
  EXPECT_THAT(ask(question).reason, testing::HasSubstr("20.0 m ahead"));
  question.s_m = 999.9;
  question.speed_mps = 0.1;
  EXPECT_TRUE(ask(question).hold);
  question.s_m = 1003.0;
  EXPECT_EQ(ask(question).set.speed_mps, 0.0);
}

TEST(Decision, ApproachesALeadDownToItsSpeedAndGap) {
  planning::SpeedQuestion question = free_road(10.0);
  question.lead_name = "car a";
  question.lead = planning::Lead{.gap_m = 1.5 * 4.0 + 5.0, .speed_mps = 4.0};
  const planning::SpeedAnswer close = ask(question);
  EXPECT_EQ(close.behaviour, planning::Behaviour::follow);
  EXPECT_LT(close.set.speed_mps, 5.5);
  EXPECT_THAT(close.reason, testing::StartsWith("car a is 11.0 m ahead"));
  question.lead->gap_m = 200.0;
  EXPECT_EQ(ask(question).behaviour, planning::Behaviour::cruise);
}

TEST(Decision, LeavesTheGapToTheCruiseControlOnceClosingIsOver) {
  planning::SpeedQuestion question = free_road(4.0);
  for (const double off_m : {-0.25, 0.0, 0.25}) {
    question.lead = planning::Lead{.gap_m = 1.5 * 4.0 + 5.0 + off_m, .speed_mps = 4.0};
    EXPECT_GT(ask(question).set.speed_mps, 5.0) << off_m << " m";
    EXPECT_EQ(ask(question).set.acceleration_mps2, 0.0) << off_m << " m";
  }
}

TEST(Decision, ApproachClosesAsTheCruiseControlDoes) {
  const control::CruiseDesign design = control::design_cruise({});
  // −K x = 0 at constant speeds, x = [τ_h c − left, −c, 0], c the closing.
  const double closing_s = planning::DecisionOptions{}.headway_s - design.K[1] / design.K[0];
  EXPECT_NEAR(planning::DecisionOptions{}.closing_s, closing_s, 0.05);
}

// A cycle later everything is a little further: so is what is asked for.
TEST(Decision, BrakingForALeadSetsInGradually) {
  planning::SpeedQuestion question = free_road(9.0);
  double last_mps2 = 0.0;
  for (double gap_m = 60.0; gap_m > 20.0; gap_m -= 0.1 * 7.0) {
    question.lead = planning::Lead{.gap_m = gap_m, .speed_mps = 2.0};
    const double asked_mps2 = ask(question).set.acceleration_mps2;
    EXPECT_NEAR(asked_mps2, last_mps2, 0.4) << gap_m << " m";
    last_mps2 = asked_mps2;
  }
  EXPECT_NEAR(last_mps2, -1.5, 1e-12);
}

TEST(Decision, BrakesForALeadThatBrakesToAStop) {
  planning::SpeedQuestion question = free_road(10.0);
  question.lead = planning::Lead{.gap_m = 35.0, .speed_mps = 8.0};
  EXPECT_EQ(ask(question).behaviour, planning::Behaviour::cruise);
  question.lead->acceleration_mps2 = -4.0;  // it stands after 8 m: 38 m are left to stop in
  question.speed_mps = 12.0;
  const planning::SpeedAnswer answer = ask(question);
  EXPECT_LT(answer.set.speed_mps, 10.7);
  EXPECT_EQ(answer.behaviour, planning::Behaviour::follow);
  question.lead->gap_m = 20.0;
  EXPECT_NEAR(ask(question).set.acceleration_mps2, -1.5, 1e-12);
}

TEST(Decision, WaitsBehindAStandingLeadAndFollowsWhenItLeaves) {
  planning::SpeedQuestion question = free_road(0.0);
  question.lead = planning::Lead{.gap_m = 5.2};
  EXPECT_TRUE(ask(question).hold);
  question.lead->speed_mps = 1.0;
  EXPECT_FALSE(ask(question).hold);
}

TEST(Decision, HaltIsStoppedAtWithItsOwnDeceleration) {
  planning::SpeedQuestion question = free_road(10.0);
  question.halt = planning::StopConstraint{
      .s_m = 24.0, .reason = "light 1 is yellow", .deceleration_mps2 = 2.1};
  const planning::SpeedAnswer answer = ask(question);
  EXPECT_EQ(answer.behaviour, planning::Behaviour::yield);
  EXPECT_NEAR(answer.set.acceleration_mps2, -2.1, 1e-12);
}

TEST(Decision, StopsBeforeTheLastPathEndsWhenNothingIsFeasible) {
  planning::SpeedQuestion question = free_road(8.0);
  question.path_left_m = 16.0;
  EXPECT_EQ(ask(question).behaviour, planning::Behaviour::stop);
  EXPECT_NEAR(ask(question).set.acceleration_mps2, -2.0, 1e-12);
  EXPECT_FALSE(ask(question).hold);
  question.path_left_m = 200.0;  // far enough to drive on until the next cycle
  EXPECT_EQ(ask(question).behaviour, planning::Behaviour::cruise);
  question.path_left_m = 0.0;
  EXPECT_EQ(ask(question).set.speed_mps, 0.0);
}

}  // namespace
}  // namespace roadbed::tools
