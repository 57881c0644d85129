#include "roadbed/tools/simulation/outside_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/cli/line_process.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kGoalX_m = 120.0;

Scenario outside_scenario() {
  Scenario scenario;
  scenario.start_speed_mps = 8.0;
  scenario.duration_s = 40.0;
  return scenario;
}

World outside_world(std::vector<planning::Obstacle> obstacles = {}) {
  return tests::straight_world({.width_m = 8.0, .goal_x_m = kGoalX_m}, std::move(obstacles));
}

planning::Obstacle standing(double x_m, double y_m) {
  planning::Obstacle obstacle{.id = "box", .motion = {}};
  obstacle.motion = drive_through({{0.0, {x_m, y_m, 0.0}}});
  return obstacle;
}

/// Along y = 0.5 sin(x / 12) at 8 m/s, to a stop at the goal at 1.5 m/s².
OutsidePlan wave(const Observation& seen) {
  constexpr double step_s = 0.1, brake_mps2 = 1.5;
  std::vector<geometry::TrajectoryPoint> rows;
  double x_m = seen.ego.x_m, speed_mps = seen.ego.speed_mps;
  for (int i = 0; i <= 40; ++i) {
    const double slope = 0.5 / 12.0 * std::cos(x_m / 12.0);
    rows.push_back({.t_s = seen.t_s + i * step_s,
                    .x_m = x_m,
                    .y_m = 0.5 * std::sin(x_m / 12.0),
                    .heading_rad = std::atan(slope),
                    .speed_mps = speed_mps});
    const double left_m = std::max(0.0, seen.goal.x() - x_m);
    speed_mps = std::min({8.0, speed_mps + step_s, std::sqrt(2.0 * brake_mps2 * left_m)});
    x_m += step_s * speed_mps;
  }
  return {geometry::Trajectory(std::move(rows)), "waves"};
}

TEST(OutsidePlanner, IsFollowedToTheGoal) {
  World world = outside_world();
  const Drive drive = tools::drive(outside_scenario(), world, {.outside_planner = wave});
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  for (const geometry::TrajectoryPoint& row : drive.trajectory.points()) {
    if (row.x_m < 60.0) continue;  // it starts in the middle, beside the wave
    EXPECT_NEAR(row.y_m, 0.5 * std::sin(row.x_m / 12.0), 0.08) << row.t_s;
  }
  for (const DriveCycle& cycle : drive.cycles) {
    EXPECT_TRUE(cycle.has_plan());
    EXPECT_FALSE(cycle.chosen.has_value());
    EXPECT_EQ(cycle.reason, "waves");
  }
}

TEST(OutsidePlanner, SeesWhatIsThere) {
  World world = outside_world({standing(60.0, 3.0)});
  std::vector<double> times;
  const OutsidePlanner looks = [&](const Observation& seen) {
    times.push_back(seen.t_s);
    EXPECT_EQ(seen.obstacles.size(), 1u);
    EXPECT_EQ(seen.obstacles[0].id, "box");
    EXPECT_EQ(seen.obstacles[0].speed_mps, 0.0);
    EXPECT_EQ(seen.obstacles[0].pose.x_m, 60.0 + world.road_map.origin_in_source().x());
    EXPECT_NEAR(seen.goal.x(), kGoalX_m, 0.5);
    return wave(seen);
  };
  tools::drive(outside_scenario(), world, {.outside_planner = looks});
  ASSERT_GT(times.size(), 10u);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i] - times[i - 1], 0.1, 1e-9);
}

TEST(OutsidePlanner, IsJudgedAsRoadbedsOwn) {
  World world = outside_world({standing(60.0, 0.5)});
  const Drive drive = tools::drive(outside_scenario(), world, {.outside_planner = wave});
  EXPECT_EQ(drive.verdict.outcome, Outcome::collision);
}

TEST(OutsidePlanner, WithoutATrajectoryTheVehicleStops) {
  World world = outside_world();
  const Drive drive =
      tools::drive(outside_scenario(), world,
                   {.outside_planner = [](const Observation&) -> OutsidePlan { return {}; }});
  EXPECT_NE(drive.verdict.outcome, Outcome::goal_reached);
  EXPECT_EQ(drive.trajectory.points().back().speed_mps, 0.0);
  EXPECT_FALSE(drive.cycles.front().has_plan());
}

TEST(OutsidePlanner, WhatItThrowsEndsTheDrive) {
  World world = outside_world();
  const OutsidePlanner fails = [](const Observation& seen) -> OutsidePlan {
    if (seen.t_s > 0.5) throw std::runtime_error("lost");
    return wave(seen);
  };
  EXPECT_THROW(tools::drive(outside_scenario(), world, {.outside_planner = fails}),
               std::runtime_error);
}

TEST(OutsidePlan, IsReadOrRefusedWithItsPlace) {
  const OutsidePlan plan = parse_outside_plan(
      R"({"trajectory":[[0,1,2,0,5],[0.5,3.5,2,0,5,0.1,0.01,0.002]],"reason":"a\nb"})", "p");
  ASSERT_EQ(plan.trajectory.points().size(), 2u);
  EXPECT_EQ(plan.trajectory.points()[1].curvature_per_m, 0.002);
  EXPECT_EQ(plan.reason, "a b");
  EXPECT_TRUE(parse_outside_plan(R"({"trajectory":null})", "p").trajectory.empty());
  const std::pair<const char*, const char*> faults[] = {
      {"[]", "is no answer"},
      {"{}", "is no answer"},
      {"not json", "p"},
      {R"({"trajectory":[[0,1,2,0]]})", "has 4 numbers"},
      {R"({"trajectory":[[0,1,2,0,"x"]]})", "/trajectory/0/4"},
      {R"({"trajectory":[[1,1,2,0,5],[1,2,2,0,5]]})", "no later than the row before"},
      {R"({"trajectory":[[0,0,0,0,5],[0.1,900,0,0,5]]})", "row 1"},
      {R"({"trajectory":null,"other":1})", "other"}};
  for (const auto& [bytes, found] : faults) {
    try {
      parse_outside_plan(bytes, "p");
      ADD_FAILURE() << bytes;
    } catch (const map::InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(found)) << bytes;
    }
  }
}

TEST(PlannerProcess, AnswersALineWithALine) {
  const NoPipeSignal no_signal;
  World world = outside_world();
  const Drive drive = tools::drive(
      outside_scenario(), world,
      {.outside_planner = planner_process(
           "while read -r line; do echo '{\"trajectory\":null,\"reason\":\"waits\"}'; done",
           60.0)});
  EXPECT_EQ(drive.cycles.back().reason, "waits");
  EXPECT_EQ(drive.trajectory.points().back().speed_mps, 0.0);
}

TEST(PlannerProcess, OneThatFailsIsTold) {
  const NoPipeSignal no_signal;
  const std::pair<const char*, const char*> faults[] = {
      {"read -r line; exit 1", "ended with exit status 1"},
      {"read -r line; echo nonsense; sleep 1", "nonsense"},
      {"sleep 1000", "gave no answer within 0.3 s"}};
  for (const auto& [command, found] : faults) {
    World world = outside_world();
    try {
      tools::drive(outside_scenario(), world, {.outside_planner = planner_process(command, 0.3)});
      ADD_FAILURE() << command;
    } catch (const map::InputError& error) {
      EXPECT_THAT(error.what(),
                  testing::HasSubstr(found == std::string("nonsense") ? command : found));
    }
  }
}

}  // namespace
}  // namespace roadbed::tools
