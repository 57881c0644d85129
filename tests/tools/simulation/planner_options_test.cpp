#include "roadbed/tools/simulation/planner_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

using planning::CostTerm;
using planning::DrivingOptions;

PlannerChanges changes_of(const std::string& text) { return parse_planner_options(text, "o.json"); }

DrivingOptions options_of(const std::string& text) {
  DrivingOptions options;
  changes_of(text).apply_to(options);
  return options;
}

TEST(PlannerOptions, StandInPlaceOfTheStyleAndTheStyleOfTheScenario) {
  const DrivingOptions options = options_of(
      R"({"weights": {"offset": 2.5, "time": 0}, "limits": {"headway_s": 1.8}, "style": "gentle"})");
  EXPECT_EQ(options.headway_s, 1.8);
  EXPECT_EQ(options.max_lateral_acceleration_mps2, 1.5);
  EXPECT_EQ(options.clearance_m, DrivingOptions{}.clearance_m);
  EXPECT_EQ(planning::of(options.weights, CostTerm::offset), 2.5);
  EXPECT_EQ(planning::of(options.weights, CostTerm::time), 0.0);
  EXPECT_EQ(planning::of(options.weights, CostTerm::length),
            planning::of(planning::default_weights(), CostTerm::length));
}

std::string refusal(const std::string& text) {
  return tests::refusal_of([&] { changes_of(text); });
}

TEST(PlannerOptions, RefuseWhatIsUnknownOrOutOfRangeAndNameThePlace) {
  const auto expect = [](const std::string& text, const std::string& start) {
    EXPECT_EQ(refusal(text).substr(0, start.size()), start);
  };
  expect(R"({"weights": {"offset": -1}})", "o.json:/weights/offset: is -1, needs 0 to 1000000");
  expect(R"({"weights": {"ofset": 1}})", "o.json:/weights/ofset: is no term of the cost");
  expect(R"({"weights": {"offset": 1e999}})", "o.json");
  expect(R"({"limits": {"clearance_m": "1"}})", "o.json:/limits/clearance_m: ");
  expect(R"({"limits": {"headway_s": 0}})", "o.json:/limits/headway_s: is 0, needs 0.5 to 5");
  expect(R"({"limits": {"pedals": true}})", "o.json:/limits/pedals: is not a known key");
  expect(R"({"offset": 1})", "o.json:/offset: is not a known key");
  expect(R"({"style": "wild"})", "o.json:/style: is \"wild\", needs gentle, normal or sporty");
  expect("[1, 2]", "o.json");
  expect("", "o.json");
}

Drive driven_with(const std::string& scenario_name, const std::string& options) {
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / scenario_name);
  changes_of(options).apply_to(scenario.options);
  World world = make_world(scenario);
  return drive(scenario, world);
}

double clearance_m(const Drive& drive) {
  return std::ranges::min(drive.samples, {}, &DriveSample::clearance_m).clearance_m;
}

TEST(PlannerOptions, RestatedDefaultsAreTheSameDrive) {
  const DrivingOptions defaults;
  std::string restated = R"({"style": "normal", "weights": {)";
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    restated += (i > 0 ? ", \"" : "\"") + std::string(planning::to_string(term)) +
                "\": " + std::to_string(planning::of(defaults.weights, term));
  }
  restated += R"(}, "limits": {"clearance_m": 0.3, "standstill_gap_m": 5}})";
  EXPECT_EQ(write_trajectory_csv(driven_with("parked_car.json", restated).trajectory),
            write_trajectory_csv(driven_with("parked_car.json", "{}").trajectory));
}

TEST(PlannerOptions, SportierStylesAreFasterRoundARoundabout) {
  const auto at_goal_s = [](const std::string& style) {
    const Drive drive = driven_with("roundabout.json", R"({"style": ")" + style + "\"}");
    EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
    return drive.verdict.at_s;
  };
  const double gentle_s = at_goal_s("gentle"), normal_s = at_goal_s("normal");
  EXPECT_GT(gentle_s, normal_s + 2.0);
  EXPECT_GT(normal_s, at_goal_s("sporty") + 1.0);
}

TEST(PlannerOptions, ClearanceIsKeptBesideAParkedCar) {
  for (const double asked_m : {0.3, 0.5, 0.7}) {
    const std::string limits = R"({"limits": {"clearance_m": )" + std::to_string(asked_m) + "}}";
    const double kept_m = clearance_m(driven_with("parked_car.json", limits));
    EXPECT_GE(kept_m, asked_m - 0.01);
    EXPECT_LT(kept_m, asked_m + 0.1);
  }
}

// It is past the slower car by then.
TEST(PlannerOptions, DesiredSpeedIsKept) {
  const Drive slow = driven_with("pass_car.json", R"({"limits": {"desired_speed_mps": 9}})");
  EXPECT_NEAR(slow.trajectory.at(9.0).speed_mps, 9.0, 0.3);
  EXPECT_NEAR(driven_with("pass_car.json", "{}").trajectory.at(9.0).speed_mps, 12.0, 0.3);
}

double mean_length_m(const Drive& drive) {
  double sum_m = 0.0;
  for (const DriveCycle& cycle : drive.cycles) sum_m += cycle.chosen ? cycle.chosen->end_l_m : 0.0;
  return sum_m / static_cast<double>(drive.cycles.size());
}

TEST(PlannerOptions, WeightsChooseTheCandidates) {
  const Drive hurried =
      driven_with("lane_change.json", R"({"weights": {"length": 0, "time": 50, "curvature": 0}})");
  EXPECT_LT(mean_length_m(hurried), mean_length_m(driven_with("lane_change.json", "{}")) - 3.0);
}

// 12 m/s behind a lead at 8 m/s on a one-way road: the gap that it settles at is τ_h v + d_0.
double settled_gap_m(const std::string& limits) {
  World world = tests::straight_world({.to_x_m = 960.0, .width_m = 3.5, .goal_x_m = 900.0},
                                      {{.id = "lead",
                                        .motion = drive_along(
                                            [](double distance_m) {
                                              return geometry::Pose2{70.0 + distance_m, 0.0, 0.0};
                                            },
                                            1e4, {{0.0, 8.0}}, 120.0)}});
  Scenario scenario;
  scenario.start_speed_mps = 12.0;
  scenario.duration_s = 50.0;
  changes_of(limits).apply_to(scenario.options);
  const Drive drive = tools::drive(scenario, world);
  return drive.cycles.back().lead ? drive.cycles.back().lead->gap_m : -1.0;
}

TEST(PlannerOptions, HeadwayAndStandstillGapAreKeptBehindALead) {
  EXPECT_NEAR(settled_gap_m("{}"), 1.5 * 8.0 + 5.0, 0.7);
  EXPECT_NEAR(settled_gap_m(R"({"limits": {"headway_s": 2.5}})"), 2.5 * 8.0 + 5.0, 0.7);
  EXPECT_NEAR(settled_gap_m(R"({"limits": {"standstill_gap_m": 9}})"), 1.5 * 8.0 + 9.0, 0.7);
}

}  // namespace
}  // namespace roadbed::tools
