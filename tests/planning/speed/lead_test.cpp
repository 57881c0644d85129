#include "roadbed/planning/speed/lead.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbed::tools {
namespace {

const geometry::VehicleShape kVehicle;

planning::Obstacle car(const std::string& id, double x_m, double y_m, double heading_rad = 0.0) {
  planning::Obstacle obstacle{.id = id, .motion = {}};
  obstacle.motion =
      geometry::Trajectory({{.t_s = 0.0, .x_m = x_m, .y_m = y_m, .heading_rad = heading_rad}});
  return obstacle;
}

planning::Obstacle moving(const std::string& id, double x_m, double y_m, double speed_mps) {
  planning::Obstacle obstacle{.id = id, .motion = {}};
  const double heading = speed_mps < 0.0 ? M_PI : 0.0, speed = std::abs(speed_mps);
  obstacle.motion = geometry::Trajectory(
      {{.t_s = 0.0, .x_m = x_m, .y_m = y_m, .heading_rad = heading, .speed_mps = speed},
       {.t_s = 10.0,
        .x_m = x_m + 10.0 * speed_mps,
        .y_m = y_m,
        .heading_rad = heading,
        .speed_mps = speed}});
  return obstacle;
}

class LeadTest : public testing::Test {
 protected:
  std::optional<planning::Lead> find(const std::vector<planning::Obstacle>& obstacles,
                                     double t_s = 0.0) {
    return find_lead(path_, 10.0, 80.0, obstacles, t_s, kVehicle, 0.1);
  }

  const planning::ReferenceLine line_ =
      planning::ReferenceLine::through({{0, 0}, {100, 0}, {200, 0}}, 4.0, 10.0);
  const planning::PlannedPath path_{line_,
                                    [](double s_m) { return planning::LateralState{.s_m = s_m}; }};
};

TEST_F(LeadTest, GapIsFromBumperToBumper) {
  const auto lead = find({car("far", 70.0, 0.0), car("near", 40.0, 0.5)});
  ASSERT_TRUE(lead);
  EXPECT_EQ(lead->obstacle, 1U);
  // Side margin included: 0.1 m before the rear bumper at 40 − 2.25 m.
  EXPECT_NEAR(lead->gap_m, 37.75 - 0.1 - (10.0 + kVehicle.front_m()), 0.01);
  EXPECT_EQ(lead->speed_mps, 0.0);
}

TEST_F(LeadTest, WhatIsBesideOrBehindIsNoLead) {
  EXPECT_FALSE(find({car("beside", 40.0, 0.5 * kVehicle.width_m + 0.9 + 0.11)}));
  EXPECT_TRUE(find({car("grazed", 40.0, 0.5 * kVehicle.width_m + 0.9 + 0.09)}));
  EXPECT_FALSE(find({car("behind", 0.0, 0.0)}));
  EXPECT_FALSE(find({car("too far", 120.0, 0.0)}));
  EXPECT_FALSE(find({}));
}

TEST_F(LeadTest, WhoIsNotThereYetOrAnyMoreIsNoLead) {
  planning::Obstacle visitor = car("visitor", 40.0, 0.0);
  visitor.validity = {2.0, 4.0};
  EXPECT_FALSE(find({visitor}, 1.9));
  EXPECT_TRUE(find({visitor}, 3.0));
  EXPECT_FALSE(find({visitor}, 4.1));
}

TEST_F(LeadTest, SpeedIsThatAlongThePathAtTheTime) {
  const auto away = find({moving("m", 30.0, 0.0, 4.0)}, 5.0);
  ASSERT_TRUE(away);
  EXPECT_NEAR(away->speed_mps, 4.0, 1e-9);
  EXPECT_NEAR(away->gap_m, 50.0 - 2.25 - 0.1 - (10.0 + kVehicle.front_m()), 0.01);
  const auto towards = find({moving("o", 80.0, 0.0, -3.0)}, 5.0);
  ASSERT_TRUE(towards);
  EXPECT_NEAR(towards->speed_mps, -3.0, 1e-9);
}

TEST(Safety, StaysQuietWhileTheCruiseControlCanStop) {
  EXPECT_FALSE(planning::emergency_deceleration_mps2(10.0, {.gap_m = 40.0}));
  EXPECT_FALSE(planning::emergency_deceleration_mps2(10.0, {.gap_m = 5.0, .speed_mps = 10.0}));
  EXPECT_FALSE(planning::emergency_deceleration_mps2(0.0, {.gap_m = 0.5, .speed_mps = -3.0}));
}

TEST(Safety, DemandsWhatStopsBeforeTheLead) {
  const auto braking = planning::emergency_deceleration_mps2(10.0, {.gap_m = 17.0});
  ASSERT_TRUE(braking);
  // Reaction at full speed, then constant braking, ends at the standoff.
  EXPECT_NEAR(0.45 * 10.0 + 10.0 * 10.0 / (2.0 * *braking), 17.0 - 1.0, 1e-9);
  EXPECT_EQ(planning::emergency_deceleration_mps2(10.0, {.gap_m = 2.0}), 8.0);
  EXPECT_TRUE(planning::emergency_deceleration_mps2(10.0, {.gap_m = 25.0, .speed_mps = -5.0}));
}

}  // namespace
}  // namespace roadbed::tools
