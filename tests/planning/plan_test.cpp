#include "roadbed/planning/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

using geometry::VehicleShape;
using tests::AnalyticLine;

Obstacle parked_at(double x_m, double y_m) {
  return {.id = "parked", .motion = geometry::Trajectory({{.x_m = x_m, .y_m = y_m}})};
}

Obstacle moving(double x_m, double y_m, double speed_mps) {
  return {
      .id = "moving",
      .motion = geometry::Trajectory({{.t_s = 0.0, .x_m = x_m, .y_m = y_m},
                                      {.t_s = 20.0, .x_m = x_m + 20.0 * speed_mps, .y_m = y_m}})};
}

Plan plan_on(const AnalyticLine& line, const LateralState& start,
             const std::vector<Obstacle>& obstacles, double speed_mps = 10.0,
             const PlanOptions& options = {}) {
  return plan_path({.line = line.view(),
                    .start = start,
                    .speed = {.speed_mps = speed_mps, .target_mps = speed_mps},
                    .obstacles = obstacles},
                   VehicleShape{}, options);
}

TEST(PlanPath, StaysOnAnEmptyStraightRoad) {
  const Plan plan = plan_on({}, {}, {});
  ASSERT_TRUE(plan.chosen) << plan.reason;
  EXPECT_EQ(plan.chosen->end_d_m, 0.0);
  for (const auto& point : plan.trajectory.points()) EXPECT_NEAR(point.y_m, 0.0, 1e-12);
}

TEST(PlanPath, ReturnsToTheLineFromBesideIt) {
  const Plan plan = plan_on({}, {.d_m = 1.5}, {});
  ASSERT_TRUE(plan.chosen) << plan.reason;
  EXPECT_LT(std::abs(plan.chosen->end_d_m), 0.5);
  EXPECT_NEAR(plan.trajectory.points().front().y_m, 1.5, 1e-12);
}

TEST(PlanPath, PassesAParkedCarWithTheClearanceAsked) {
  const Plan plan = plan_on({}, {}, {parked_at(25.0, -1.0)});
  ASSERT_TRUE(plan.chosen) << plan.reason;
  // Both cars are straight when they are side by side: half widths and the clearance.
  EXPECT_GE(plan.chosen->end_d_m, -1.0 + 0.5 * 1.8 + 0.5 * 1.61 + 0.3);
  EXPECT_LT(plan.chosen->end_d_m, 1.5);
}

TEST(PlanPath, GoesBehindASlowerCarOnlyIfItIsNotReachedInTime) {
  EXPECT_EQ(plan_on({}, {}, {moving(25.0, 0.0, 10.0)}).chosen->end_d_m, 0.0);
  EXPECT_GT(std::abs(plan_on({}, {}, {moving(16.0, 0.0, 2.0)}).chosen->end_d_m), 1.5);
}

TEST(PlanPath, SaysWhyNothingIsLeftBeforeABlockedRoad) {
  const std::vector<Obstacle> wall = {parked_at(20.0, -4.0), parked_at(20.0, -2.0),
                                      parked_at(20.0, 0.0), parked_at(20.0, 2.0),
                                      parked_at(20.0, 4.0)};
  const Plan plan = plan_on({}, {}, wall);
  EXPECT_FALSE(plan.chosen);
  EXPECT_TRUE(plan.trajectory.empty());
  EXPECT_NE(plan.reason.find("none of 5396 candidates"), std::string::npos) << plan.reason;
  EXPECT_NE(plan.reason.find("collide"), std::string::npos) << plan.reason;
  std::size_t rejected = 0;
  for (const std::size_t count : plan.rejected) rejected += count;
  EXPECT_EQ(rejected, 5396u);
}

// A car that comes across from the left and is in the way at x = 22 m from 1.4 s to 2.6 s.
PredictedObstacle crossing_car() {
  return {.id = "crossing",
          .motion = Prediction::constant_velocity(
              {.t_s = 2.0, .pose = {22.0, 0.0, -0.5 * std::numbers::pi}, .speed_mps = 10.0})};
}

TEST(PlanPath, MeetsAPredictedCarOnlyIfItIsThereAtTheSameTime) {
  const std::vector<PredictedObstacle> predicted = {crossing_car()};
  const AnalyticLine line;
  const auto planned = [&](double speed_mps, double acceleration_mps2, double target_mps) {
    return plan_path({.line = line.view(),
                      .start = {},
                      .speed = {speed_mps, acceleration_mps2, target_mps},
                      .obstacles = {},
                      .predicted = predicted},
                     VehicleShape{});
  };
  const auto keeps_straight = [](const Plan& plan) {
    return plan.chosen && plan.chosen->end_d_m == 0.0;
  };
  EXPECT_FALSE(keeps_straight(planned(10.0, 0.0, 10.0)));  // there at 1.8 s to 2.4 s
  EXPECT_TRUE(keeps_straight(planned(20.0, 0.0, 20.0)));   // gone by 1.3 s
  EXPECT_TRUE(keeps_straight(planned(4.0, 0.0, 4.0)));     // comes at 4.3 s
  EXPECT_TRUE(keeps_straight(planned(10.0, -4.0, 0.0)));   // stops after 12.5 m
}

TEST(PlanPath, DrivesAtTheSpeedsOfAProfileThatItIsGiven) {
  const std::vector<PredictedObstacle> predicted = {crossing_car()};
  const std::vector<SpeedSample> slow = {{0.0, 10.0, -3.0}, {12.0, 5.0, 0.0}, {40.0, 5.0, 0.0}};
  const AnalyticLine line;
  PlanInput input{.line = line.view(),
                  .start = {},
                  .speed = {10.0, 0.0, 10.0},
                  .obstacles = {},
                  .predicted = predicted,
                  .speed_profile = slow};
  const Plan plan = plan_path(input, VehicleShape{});  // there at 2.9 s to 4.3 s
  ASSERT_TRUE(plan.chosen) << plan.reason;
  EXPECT_EQ(plan.chosen->end_d_m, 0.0);
  EXPECT_EQ(plan.trajectory.points().front().speed_mps, 10.0);
  EXPECT_NEAR(plan.trajectory.points().back().speed_mps, 5.0, 1e-12);
}

TEST(PlanPath, LateralStateIsThatOfTheDrive) {
  const Plan plan = plan_on({}, {.s_m = 3.0, .d_m = 1.0, .d_slope = 0.05}, {});
  ASSERT_TRUE(plan.chosen) << plan.reason;
  for (const auto& point : plan.trajectory.points()) {
    const LateralState state = plan.lateral_at(point.x_m);
    EXPECT_NEAR(state.d_m, point.y_m, 1e-12);
    EXPECT_NEAR(std::atan(state.d_slope), point.heading_rad, 1e-12);
  }
}

TEST(PlanPath, RefusesOptionsThatCannotBeUsed) {
  const auto with = [](auto change) {
    PlanOptions options;
    change(options);
    return options;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const PlanOptions& options :
       {with([](PlanOptions& o) { o.points = 1; }), with([](PlanOptions& o) { o.d_step_m = 0.0; }),
        with([](PlanOptions& o) { o.min_l_m = 31.0; }),
        with([](PlanOptions& o) { o.min_l_m = 0.0; }),
        with([&](PlanOptions& o) { o.max_d_m = nan; }),
        with([&](PlanOptions& o) { of(o.weights, CostTerm::time) = nan; }),
        with([](PlanOptions& o) { of(o.weights, CostTerm::offset) = -1.0; }),
        with([](PlanOptions& o) { o.circles = 0; }),
        with([](PlanOptions& o) { o.clearance_m = -0.1; })}) {
    EXPECT_THROW(plan_on({}, {}, {}, 10.0, options), std::invalid_argument);
  }
  EXPECT_THROW(plan_on({}, {.d_m = nan}, {}), std::invalid_argument);
  EXPECT_THROW(plan_on({}, {}, {}, -1.0), std::invalid_argument);
}

TEST(PlanPath, SaysThatTheStartIsOffTheRoad) {
  AnalyticLine line;
  line.left_m = line.right_m = 2.0;
  const Plan plan = plan_on(line, {.d_m = 30.0}, {});
  ASSERT_FALSE(plan.chosen);
  // Half the width beyond the edge, too.
  EXPECT_EQ(plan.reason.find("the start is 28.80 m off the road: none of"), 0u) << plan.reason;
}

TEST(PlanPath, SaysThatTheVehicleIsWiderThanTheRoad) {
  AnalyticLine line;
  line.left_m = line.right_m = 0.7;
  const Plan plan = plan_on(line, {}, {});
  ASSERT_FALSE(plan.chosen);
  EXPECT_EQ(plan.reason.find("the vehicle is 1.61 m wide and the road 1.40 m: none of"), 0u)
      << plan.reason;
}

// A sudden swerve at speed turns the wheels faster than they can.
TEST(PlanPath, KeepsToTheSteeringRate) {
  AnalyticLine line;
  line.left_m = line.right_m = 6.0;
  PlanOptions options;
  options.min_l_m = options.max_l_m = 15.0;
  options.max_lateral_acceleration_mps2 = 100.0;
  options.keep_candidates = true;
  const VehicleShape vehicle;
  const Plan plan = plan_on(line, {}, {}, 14.0, options);
  int beyond = 0;
  for (const Candidate& candidate : plan.candidates) {
    // By differences of the steering angle of the lane change beside a straight line.
    const geometry::Quintic d({}, {.value = candidate.end_d_m}, candidate.end_l_m);
    double rate_radps = 0.0;
    for (double l_m = 0.0; l_m + 0.01 < candidate.end_l_m; l_m += 0.01) {
      const auto steering = [&](double at_m) {
        const auto p = d.at(at_m);
        return std::atan(vehicle.wheelbase_m * p[2] / std::pow(1.0 + p[1] * p[1], 1.5));
      };
      const double way_m = 0.01 * std::hypot(1.0, d.at(l_m)[1]);
      rate_radps =
          std::max(rate_radps, std::abs(steering(l_m + 0.01) - steering(l_m)) / way_m * 14.0);
    }
    const bool is_beyond = candidate.rejection == Rejection::steering_rate;
    if (is_beyond) {
      EXPECT_GT(rate_radps, vehicle.max_steering_rate_radps - 0.01);
    }
    if (candidate.rejection == Rejection::none) {
      EXPECT_LT(rate_radps, vehicle.max_steering_rate_radps + 0.03);  // 31 points see no peak
    }
    beyond += is_beyond ? 1 : 0;
  }
  EXPECT_GT(beyond, 10);
  options.limit_steering_rate = false;
  for (const Candidate& candidate : plan_on(line, {}, {}, 14.0, options).candidates) {
    EXPECT_NE(candidate.rejection, Rejection::steering_rate);
  }
}

}  // namespace
}  // namespace roadbed::planning
