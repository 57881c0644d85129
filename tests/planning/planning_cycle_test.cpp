#include "roadbed/planning/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

using geometry::VehicleShape;
using tests::AnalyticLine;

struct CycleScene {
  AnalyticLine line;
  LateralState start;
  SpeedPlan speed;
  std::vector<Obstacle> obstacles;

  PlanInput input() const {
    return {.line = line.view(), .start = start, .speed = speed, .obstacles = obstacles};
  }
};

CycleScene random_cycle_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  CycleScene scene;
  scene.line.curvature = {0.04 * unit(random), 1e-3 * unit(random), 0.0, 0.0, 0.0};
  scene.line.left_m = scene.line.right_m = 3.5 + 0.8 * unit(random);
  scene.start = {.s_m = 2.0, .d_m = 0.6 * unit(random), .d_slope = 0.04 * unit(random)};
  const double v = 8.0 + 5.0 * unit(random);
  scene.speed = {.speed_mps = v, .acceleration_mps2 = unit(random), .target_mps = v};
  for (int i = 0; i < 3; ++i) {
    const ReferencePoint at = scene.line.at(25.0 + 15.0 * unit(random));
    const double side = 4.0 * unit(random);
    scene.obstacles.push_back(
        {.id = "parked",
         .motion = geometry::Trajectory({{.x_m = at.in_map.x() - side * std::sin(at.heading_rad),
                                          .y_m = at.in_map.y() + side * std::cos(at.heading_rad),
                                          .heading_rad = at.heading_rad}})});
  }
  return scene;
}

PlanOptions coarse_cycle_options() {
  PlanOptions options;
  options.l_step_m = 1.0;
  options.points = 17;
  return options;
}

struct CycleQuestion {
  SafetyMargins margins;
  EndOffsetRange ends;
};

CycleQuestion random_cycle_question(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double least_m = 0.1 * std::floor(60.0 * unit(random)) - 3.5;
  CycleQuestion asked{.margins = {0.2 - 0.4 * std::floor(2.0 * unit(random)), 0.3 * unit(random)},
                      .ends = {}};
  if (unit(random) < 0.8) asked.ends = {least_m, std::min(3.5, least_m + 0.5 + 2.0 * unit(random))};
  return asked;
}

TEST(PlanningCycle, AskedForSomeEndsItAnswersAsAGridOfThoseInWhateverOrder) {
  std::mt19937 random(21);
  int chosen = 0, none = 0;
  for (int i = 0; i < 50; ++i) {
    const CycleScene scene = random_cycle_scene(random);
    const PlanInput input = scene.input();
    const VehicleShape vehicle;
    PlanningCycle cycle(input, vehicle, coarse_cycle_options());
    for (int k = 0; k < 8; ++k) {
      const CycleQuestion asked = random_cycle_question(random);
      PlanOptions options = coarse_cycle_options();
      options.border_margin_m = asked.margins.border_margin_m;
      options.clearance_m = asked.margins.clearance_m;
      options.min_d_m = std::max(options.min_d_m, asked.ends.least_d_m);
      options.max_d_m = std::min(options.max_d_m, asked.ends.most_d_m);
      const Plan expected = plan_path(input, vehicle, options);
      const Plan found = cycle.plan(asked.margins, asked.ends);
      ASSERT_EQ(found.chosen.has_value(), expected.chosen.has_value()) << i << ", " << k;
      EXPECT_EQ(found.meets_something(), expected.meets_something());
      ++(found.chosen ? chosen : none);
      if (!found.chosen) continue;
      EXPECT_EQ(found.chosen->end_d_m, expected.chosen->end_d_m);
      EXPECT_EQ(found.chosen->end_l_m, expected.chosen->end_l_m);
      EXPECT_NEAR(found.chosen->cost, expected.chosen->cost, 1e-9);
    }
  }
  EXPECT_GT(chosen, 50);
  EXPECT_GT(none, 20);
}

TEST(PlanningCycle, CountsOnlyTheCandidatesThatItWasAskedFor) {
  std::mt19937 random(22);
  const CycleScene scene = random_cycle_scene(random);
  const PlanInput input = scene.input();
  const VehicleShape vehicle;
  PlanningCycle cycle(input, vehicle, coarse_cycle_options());
  const Plan plan = cycle.plan({-0.5, 100.0}, {0.0, 0.4});  // nothing keeps 100 m
  std::size_t rejected = 0;
  for (const std::size_t count : plan.rejected) rejected += count;
  EXPECT_EQ(rejected, 5u * 16u);
  EXPECT_NE(plan.reason.find("none of 80 candidates"), std::string::npos) << plan.reason;
}

TEST(PlanningCycle, JudgesAllThatIsAskedForAsPlansOfOneCandidateEachDo) {
  std::mt19937 random(24);
  int feasible = 0, rejected = 0;
  for (int i = 0; i < 8; ++i) {
    const CycleScene scene = random_cycle_scene(random);
    const PlanInput input = scene.input();
    const VehicleShape vehicle;
    PlanningCycle cycle(input, vehicle, coarse_cycle_options());
    const CycleQuestion asked = random_cycle_question(random);
    const Plan plan = cycle.plan(asked.margins, asked.ends);
    const Plan judged = cycle.plan_and_judge_all(asked.margins, asked.ends);
    ASSERT_EQ(judged.chosen.has_value(), plan.chosen.has_value()) << i;
    if (plan.chosen) {
      EXPECT_EQ(judged.chosen->cost, plan.chosen->cost) << i;
    }
    double cheapest = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : judged.candidates) {
      EXPECT_GE(candidate.end_d_m, asked.ends.least_d_m - 1e-9);
      EXPECT_LE(candidate.end_d_m, asked.ends.most_d_m + 1e-9);
      const bool is_feasible = candidate.rejection == Rejection::none;
      if (is_feasible) cheapest = std::min(cheapest, candidate.cost);
      // By itself it is chosen if, and only if, it is feasible; the longest one's way is checked.
      if (candidate.end_l_m < coarse_cycle_options().max_l_m - 0.5) continue;
      PlanOptions alone = coarse_cycle_options();
      alone.border_margin_m = asked.margins.border_margin_m;
      alone.clearance_m = asked.margins.clearance_m;
      alone.min_d_m = alone.max_d_m = candidate.end_d_m;
      alone.min_l_m = alone.max_l_m = candidate.end_l_m;
      EXPECT_EQ(plan_path(input, vehicle, alone).chosen.has_value(), is_feasible)
          << i << ": " << candidate.end_d_m;
      ++(is_feasible ? feasible : rejected);
    }
    if (plan.chosen) {
      EXPECT_NEAR(cheapest, plan.chosen->cost, 1e-9) << i;
    }
  }
  EXPECT_GT(feasible, 10);
  EXPECT_GT(rejected, 10);
}

TEST(PlanningCycle, RefusesEndsThatTheGridDoesNotHave) {
  std::mt19937 random(23);
  const CycleScene scene = random_cycle_scene(random);
  const PlanInput input = scene.input();
  const VehicleShape vehicle;
  PlanningCycle cycle(input, vehicle, coarse_cycle_options());
  EXPECT_THROW(cycle.plan({}, {3.6, 5.0}), std::invalid_argument);
  EXPECT_THROW(cycle.plan({}, {0.5, -0.5}), std::invalid_argument);
  EXPECT_NO_THROW(cycle.plan({}, {-0.1, 0.1}));
}

}  // namespace
}  // namespace roadbed::planning
