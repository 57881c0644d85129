// Throttle and brake in the loop: the same drives with and without them.
#include "roadbed/tools/simulation/pedal_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

Drive driven(Scenario scenario, bool pedals) {
  scenario.pedals = pedals;
  World world = make_world(scenario);
  return drive(scenario, world);
}

/// Over the bypass and the hill of the east road, 4 m high over 330 m.
Scenario over_the_hill() {
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "lane_change.json");
  scenario.start.text = "lane:6/0/-1@5";
  scenario.goal.text = "lane:6/0/-1@290";
  scenario.start_speed_mps = 10.0;
  scenario.duration_s = 60.0;
  scenario.obstacles.clear();
  return scenario;
}

void expect_alike(const Scenario& scenario, double apart_m, double apart_mps) {
  const Drive with = driven(scenario, true), without = driven(scenario, false);
  EXPECT_EQ(with.verdict.outcome, Outcome::goal_reached) << with.verdict.text;
  EXPECT_EQ(without.verdict.outcome, Outcome::goal_reached) << without.verdict.text;
  for (const auto& row : with.trajectory.points()) {
    const auto other = without.trajectory.at(row.t_s);
    EXPECT_LT((row.pose().position() - other.pose().position()).norm(), apart_m) << row.t_s;
    EXPECT_LT(std::abs(row.speed_mps - other.speed_mps), apart_mps) << row.t_s;
  }
}

TEST(PedalModel, PedalsDriveAsTheLagDoesBehindALeadThatStops) {
  expect_alike(read_scenario(tests::data_folder() / "scenarios" / "slower_lead.json"), 0.5, 0.15);
}

TEST(PedalModel, PedalsDriveAsTheLagDoesOverAHill) { expect_alike(over_the_hill(), 0.5, 0.15); }

TEST(PedalModel, PedalsAreNeverPressedTogetherAndBothAreUsed) {
  const Drive drive = driven(over_the_hill(), true);
  bool accelerates = false, brakes = false;
  for (const DriveSample& sample : drive.samples) {
    EXPECT_TRUE(sample.throttle == 0.0 || sample.brake == 0.0) << sample.t_s;
    accelerates = accelerates || sample.throttle > 0.0;
    brakes = brakes || sample.brake > 0.0;
  }
  EXPECT_TRUE(accelerates);
  EXPECT_TRUE(brakes);
}

TEST(PedalModel, GradeIsThatOfTheHill) {
  const Scenario scenario = over_the_hill();
  const World world = make_world(scenario);
  const GradeProfile grades(world.road_map, world.route, world.line);
  // 4 m up over 124 m by a cubic that begins and ends flat: at most 1.5 · 4 / 124 = 4.8 %.
  double steepest = 0.0, height_m = 0.0, highest_m = 0.0;
  for (double s_m = 0.0; s_m < 285.0; s_m += 1.0) {
    steepest = std::max(steepest, std::tan(grades.grade_rad(s_m)));
    highest_m = std::max(highest_m, height_m += std::tan(grades.grade_rad(s_m)));
  }
  EXPECT_NEAR(steepest, 1.5 * 4.0 / 124.0, 0.003);
  EXPECT_NEAR(highest_m, 4.0, 0.1);
}

}  // namespace
}  // namespace roadbed::tools
