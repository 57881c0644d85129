// Who plans and who controls mean the same vehicle: change geometry/motion/longitudinal.h, and a
// value that is written anywhere else fails here.
#include "roadbed/geometry/motion/longitudinal.h"

#include <gtest/gtest.h>

#include "roadbed/control/cruise_design.h"
#include "roadbed/control/lower_controller.h"
#include "roadbed/planning/behaviour/decision.h"
#include "roadbed/planning/speed/speed_controller.h"
#include "roadbed/planning/speed/speed_search.h"

namespace roadbed {
namespace {

constexpr geometry::Longitudinal kShared = geometry::kLongitudinal;

TEST(Longitudinal, GapIsTheSameForDecisionAndCruiseControl) {
  const planning::DecisionOptions decision;
  const control::CruiseOptions cruise;
  EXPECT_EQ(decision.headway_s, kShared.headway_s);
  EXPECT_EQ(cruise.headway_s, kShared.headway_s);
  EXPECT_EQ(decision.standstill_gap_m, kShared.standstill_gap_m);
  EXPECT_EQ(cruise.standstill_gap_m, kShared.standstill_gap_m);
}

TEST(Longitudinal, ActuatorIsTheSameForAllWhoWaitForIt) {
  EXPECT_EQ(control::CruiseOptions{}.actuator_lag_s, kShared.actuator_lag_s);
  EXPECT_EQ(control::CruiseOptions{}.actuator_gain, kShared.actuator_gain);
  EXPECT_EQ(control::ActuatorOptions{}.lag_s, kShared.actuator_lag_s);
  EXPECT_EQ(control::ActuatorOptions{}.gain, kShared.actuator_gain);
  EXPECT_EQ(control::DriveTrain{}.lag_s, kShared.actuator_lag_s);
  EXPECT_EQ(planning::DecisionOptions{}.preview_s, kShared.actuator_lag_s);
  EXPECT_EQ(planning::SafetyOptions{}.reaction_s, kShared.actuator_lag_s);
  EXPECT_EQ(planning::SpeedSearchOptions{}.actuator_lag_s, kShared.actuator_lag_s);
  EXPECT_EQ(planning::kActuatorLag_s, kShared.actuator_lag_s);
}

TEST(Longitudinal, BoundOfTheCommandAndItsCycleAreTheSame) {
  EXPECT_EQ(control::CruiseOptions{}.max_command_mps2, kShared.max_command_mps2);
  EXPECT_EQ(planning::kMostCommand_mps2, kShared.max_command_mps2);
  EXPECT_EQ(planning::SafetyOptions{}.cruise_limit_mps2, kShared.max_command_mps2);
  EXPECT_EQ(planning::SpeedSearchOptions{}.most_mps2, kShared.max_command_mps2);
  EXPECT_EQ(planning::SpeedSearchOptions{}.least_mps2, -kShared.max_command_mps2);
  EXPECT_EQ(control::CruiseOptions{}.step_s, kShared.cycle_s);
}

}  // namespace
}  // namespace roadbed
