#include "roadbed/planning/lateral/fallback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

using geometry::VehicleShape;
using tests::AnalyticLine;

Obstacle standing(double x_m, double y_m, double length_m, double width_m) {
  return {.id = "thing",
          .length_m = length_m,
          .width_m = width_m,
          .motion = geometry::Trajectory({{.x_m = x_m, .y_m = y_m}})};
}

PlanOrStop answer_on(const AnalyticLine& line, const std::vector<Obstacle>& obstacles,
                     double speed_mps, const LateralPath& previous = {},
                     const PlanOptions& options = {}) {
  return plan_or_stop({.line = line.view(),
                       .start = {},
                       .speed = {.speed_mps = speed_mps, .target_mps = speed_mps},
                       .obstacles = obstacles},
                      previous, VehicleShape{}, options);
}

std::size_t total(const RejectionCounts& counts) {
  std::size_t sum = 0;
  for (const std::size_t count : counts) sum += count;
  return sum;
}

TEST(PlanOrStop, IsThePlanWhereThereIsOne) {
  const PlanOrStop answer = answer_on({}, {}, 10.0);
  EXPECT_EQ(answer.resort, Resort::none);
  ASSERT_TRUE(answer.plan.chosen);
  EXPECT_FALSE(answer.stop);
  EXPECT_EQ(answer.attempts.size(), 1u);
  EXPECT_EQ(answer.reason, "");
}

TEST(PlanOrStop, LooksFartherToTheSideBeforeItStops) {
  // A wall up to y = 2.6 m: the rear axle has to pass at 3.7 m, the grid ends at 3.5 m.
  AnalyticLine line;
  line.left_m = 6.0;
  const PlanOrStop answer = answer_on(line, {standing(28.0, -2.3, 2.0, 10.0)}, 8.0);
  EXPECT_EQ(answer.resort, Resort::wider_grid);
  ASSERT_TRUE(answer.plan.chosen) << answer.reason;
  EXPECT_GT(answer.plan.chosen->end_d_m, 3.7);
  ASSERT_EQ(answer.attempts.size(), 2u);
  EXPECT_EQ(total(answer.attempts[0].rejected), 5396u);
  EXPECT_FALSE(answer.reason.empty());
}

TEST(PlanOrStop, LeavesTheRoadALittleOnlyWhereNothingIsInTheWay) {
  AnalyticLine narrow;
  narrow.left_m = narrow.right_m = 0.7;  // the vehicle needs 0.805 m
  narrow.curvature = {0.01, 0.0, 0.0, 0.0, 0.0};
  const LateralPath middle = [](double s_m) { return LateralState{.s_m = s_m}; };
  PlanInput input{.line = narrow.view(),
                  .start = {},
                  .speed = {.speed_mps = 5.0, .target_mps = 5.0},
                  .obstacles = {}};
  const PlanOrStop alone = plan_or_stop(input, middle, VehicleShape{});
  EXPECT_EQ(alone.resort, Resort::beyond_the_edge);
  EXPECT_EQ(alone.beyond_the_edge_m, 0.3);
  ASSERT_TRUE(alone.plan.chosen) << alone.reason;
}

TEST(PlanOrStop, StopsGentlyBeforeAWallThatIsFarEnough) {
  const PlanOrStop answer = answer_on({}, {standing(25.0, 0.0, 2.0, 40.0)}, 6.0);
  EXPECT_EQ(answer.resort, Resort::stop);
  ASSERT_TRUE(answer.stop);
  EXPECT_EQ(answer.stop->deceleration_mps2, 1.5);  // 12 m, and 20.3 m are free
  EXPECT_EQ(answer.stop->clearance_m, 0.3);
  const auto& points = answer.trajectory().points();
  EXPECT_NEAR(points.back().x_m, 6.0 * 6.0 / (2.0 * 1.5), 1e-9);
  EXPECT_EQ(points.back().speed_mps, 0.0);
  EXPECT_GE(points.back().t_s, 5.0);
  EXPECT_NE(answer.reason.find("collide"), std::string::npos) << answer.reason;
  EXPECT_NE(answer.reason.find("1.5 m/s²"), std::string::npos) << answer.reason;
  EXPECT_GT(answer.attempts.back().rejected[static_cast<std::size_t>(Rejection::collision)], 0u);
}

TEST(PlanOrStop, BrakesHarderBeforeANearWallAndSaysWhenItIsTooNear) {
  const PlanOrStop hard = answer_on({}, {standing(16.0, 0.0, 2.0, 40.0)}, 10.0);  // 11.3 m are free
  ASSERT_TRUE(hard.stop);
  EXPECT_EQ(hard.stop->deceleration_mps2, 6.0);  // 8.3 m
  EXPECT_EQ(hard.stop->clearance_m, 0.3);
  const PlanOrStop touching = answer_on({}, {standing(10.0, 0.0, 2.0, 40.0)}, 10.0);
  ASSERT_TRUE(touching.stop);
  EXPECT_EQ(touching.stop->deceleration_mps2, 6.0);
  EXPECT_FALSE(touching.stop->clearance_m);
  EXPECT_NE(touching.reason.find("touches"), std::string::npos) << touching.reason;
}

TEST(PlanOrStop, StopsAlongThePreviousPath) {
  const LateralPath previous = [](double s_m) {
    return LateralState{
        .s_m = s_m, .d_m = 0.02 * s_m * s_m, .d_slope = 0.04 * s_m, .d_curvature_per_m = 0.04};
  };
  const PlanOrStop answer = answer_on({}, {standing(25.0, 0.0, 2.0, 60.0)}, 6.0, previous);
  ASSERT_TRUE(answer.stop);
  double length_m = 0.0;
  const auto& points = answer.stop->trajectory.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].y_m, 0.02 * points[i].x_m * points[i].x_m, 1e-9);
    EXPECT_NEAR(std::tan(points[i].heading_rad), 0.04 * points[i].x_m, 1e-9);
    const double bend = 1.0 + 0.0016 * points[i].x_m * points[i].x_m;
    EXPECT_NEAR(points[i].curvature_per_m, 0.04 / (bend * std::sqrt(bend)), 1e-9);
    if (i > 0)
      length_m += std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  }
  EXPECT_NEAR(length_m, 12.0, 0.05);  // v² / 2b
}

TEST(PlanOrStop, KeepsWhereItStandsAndIsSeenToBeRunInto) {
  const std::vector<Obstacle> wall = {standing(6.0, 0.0, 2.0, 40.0)};
  const PredictedObstacle from_behind{
      .id = "car",
      .prediction = Prediction::constant_velocity({.pose = {-20.0, 0.0, 0.0}, .speed_mps = 6.0})};
  PlanInput input{.line = AnalyticLine{}.view(), .start = {}, .speed = {}, .obstacles = wall};
  const PlanOrStop alone = plan_or_stop(input, {}, VehicleShape{});
  ASSERT_TRUE(alone.stop);
  EXPECT_TRUE(alone.stop->clearance_m);
  input.predicted = {&from_behind, 1};
  const PlanOrStop hit = plan_or_stop(input, {}, VehicleShape{});
  ASSERT_TRUE(hit.stop);
  EXPECT_FALSE(hit.stop->clearance_m);
}

TEST(PlanOrStop, RefusesFallbacksThatCannotBeUsed) {
  const auto with = [](FallbackOptions fallback) {
    const std::vector<Obstacle> none;
    return plan_or_stop(
        {.line = AnalyticLine{}.view(), .start = {}, .speed = {}, .obstacles = none}, {},
        VehicleShape{}, {}, fallback);
  };
  EXPECT_THROW(with({.wider = 0.5}), std::invalid_argument);
  EXPECT_THROW(with({.shorter = 0.0}), std::invalid_argument);
  EXPECT_THROW(with({.beyond_the_edge_m = {-0.1}}), std::invalid_argument);
  EXPECT_THROW(with({.decelerations_mps2 = {}}), std::invalid_argument);
  EXPECT_THROW(with({.decelerations_mps2 = {3.0, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
