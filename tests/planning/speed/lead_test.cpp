#include "roadbed/planning/speed/lead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

// Both in small steps, the vehicle's braking lagging by 0.45 s; before it is asked for, 2.45 m/s².
TEST(Safety, StopsBehindALeadThatBrakesOnToStandstill) {
  for (const double lead_brakes_mps2 : {3.0, 4.0, 5.0, 6.0, 8.0}) {
    for (const double speed_mps : {10.0, 20.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << lead_brakes_mps2 << " m/s² from " << speed_mps << " m/s");
      double gap_m = 5.0 + 1.5 * speed_mps, own_mps = speed_mps, lead_mps = speed_mps;
      double braking_mps2 = 0.0;
      for (double t_s = 0.0; own_mps > 0.0; t_s += 0.01) {
        const auto asked = planning::emergency_deceleration_mps2(
            own_mps,
            {.gap_m = gap_m, .speed_mps = lead_mps, .acceleration_mps2 = -lead_brakes_mps2});
        braking_mps2 += 0.01 / 0.45 * (asked.value_or(2.45) - braking_mps2);
        gap_m += 0.01 * (lead_mps - own_mps);
        own_mps -= 0.01 * braking_mps2;
        lead_mps = std::max(0.0, lead_mps - 0.01 * lead_brakes_mps2);
      }
      EXPECT_GT(gap_m, 0.5);
      EXPECT_LT(gap_m, 0.8 * (5.0 + 1.5 * speed_mps));  // nor is it far more than was needed
    }
  }
}

// A line along x; the other turns onto it from the left, on a quarter of a circle of 10 m, and
// drives on.
TEST(Followers, WhoComesOntoTheLineBehindTheVehicleFollowsIt) {
  const auto line = planning::ReferenceLine::through({{-100, 0}, {0, 0}, {200, 0}}, 2.0, 14.0);
  const geometry::VehicleShape shape;
  const auto comes_behind = [&](double vehicle_x_m, double speed_mps, double other_mps) {
    planning::Obstacle other{.id = "r", .length_m = 4.5, .width_m = 1.8, .motion = {}};
    std::vector<geometry::TrajectoryPoint> points;
    for (double way_m = -20.0; way_m < 120.0; way_m += 0.25) {
      const double turned = std::clamp(way_m / 10.0, 0.0, 0.5 * std::numbers::pi);
      const double before_m = std::min(0.0, way_m),
                   behind_m = std::max(0.0, way_m - 5.0 * std::numbers::pi);
      points.push_back({.t_s = (way_m + 20.0) / other_mps,
                        .x_m = 10.0 * (1.0 - std::cos(turned)) + behind_m,
                        .y_m = 10.0 - before_m - 10.0 * std::sin(turned),
                        .heading_rad = turned - 0.5 * std::numbers::pi,
                        .speed_mps = other_mps});
    }
    other.motion = geometry::Trajectory(std::move(points));
    const planning::VehicleOnLine vehicle{line, line.project({vehicle_x_m, 0.0}).s_m, 0.0,
                                          shape.width_m};
    return planning::comes_behind(other, 0.0, vehicle, speed_mps, shape);
  };
  // It is on the line, at x = 9 m or so, after 34 m of its way.
  EXPECT_TRUE(comes_behind(5.0, 8.0, 8.0));     // the vehicle is 30 m farther by then
  EXPECT_TRUE(comes_behind(5.0, 8.0, 10.0));    // 2 m/s more are braked off
  EXPECT_FALSE(comes_behind(-40.0, 8.0, 8.0));  // it comes ahead
  EXPECT_FALSE(comes_behind(5.0, 1.0, 9.0));    // 8 m/s more in a few metres
  EXPECT_FALSE(comes_behind(-24.0, 8.0, 8.0));  // both at once
}

TEST(LeadText, WhoStandsDoesSoWhicheverWayItIsMeasuredToCreep) {
  EXPECT_EQ(planning::lead_text("car 3", 7.96, -0.04), "car 3 is 8.0 m ahead at 0.0 m/s");
  EXPECT_EQ(planning::lead_text("car 3", 7.96, 0.04), "car 3 is 8.0 m ahead at 0.0 m/s");
  EXPECT_EQ(planning::lead_text("car 3", 20.0, -0.26), "car 3 is 20.0 m ahead at -0.3 m/s");
}

}  // namespace
}  // namespace roadbed::tools
