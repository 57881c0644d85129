// Proofs that some CommonRoad problems have no solution for CommonRoad's vehicle 2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {
namespace {

CommonRoadDrive problem_named(const std::filesystem::path& real, const std::string& name) {
  return read_common_road_drive(real / "commonroad/CommonRoad+commonroad-reachable-set" / name);
}

/// Most that vehicle 2 can drive: it speeds up by 11.5 m/s², beyond 7.319 m/s by that speed's
/// power, on any path. Upper sum over small steps.
double most_driven_m(double speed_mps, double duration_s) {
  constexpr double kStep_s = 1e-4;
  double driven_m = 0.0;
  for (double t = 0.0; t < duration_s; t += kStep_s) {
    speed_mps += kStep_s * 11.5 * std::min(1.0, 7.319 / std::max(7.319, speed_mps));
    driven_m += kStep_s * speed_mps;
  }
  return driven_m;
}

/// Straight to the nearest place of the reference line at which the goal can be met.
double nearest_goal_m(const CommonRoadDrive& problem) {
  const World& world = problem.world;
  double nearest_m = 1e9;
  for (const planning::GoalStretch& stretch :
       goal_stretches(*world.goal, world.road_map, world.line, problem.scenario.vehicle)) {
    const double end_m = std::min(stretch.s_m.most, world.line.length_m());
    for (double s_m = std::max(0.0, stretch.s_m.least); s_m <= end_m; s_m += 0.1) {
      const Eigen::Vector2d apart = world.line.at(s_m).in_map - world.start.position();
      nearest_m = std::min(nearest_m, apart.norm());
    }
  }
  return nearest_m;
}

TEST(Unsolvable, BoundOfWhatCanBeDrivenIsAboveWhatConstantPowerGives) {
  // From 7.319 m/s on v² grows by 2 P t: s = (v³ − v₀³) / (3 P), P = 11.5 · 7.319 m²/s³.
  const double power = 11.5 * 7.319, end = std::sqrt(7.319 * 7.319 + 2.0 * power * 3.0);
  const double truth = (end * end * end - 7.319 * 7.319 * 7.319) / (3.0 * power);
  EXPECT_NEAR(most_driven_m(7.319, 3.0), truth, 0.01);
  EXPECT_GE(most_driven_m(7.319, 3.0), truth);
}

TEST(Unsolvable, DeuOfflineAsksForMoreThanTheEngineGives) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const CommonRoadDrive problem = problem_named(folder, "DEU_Offline-1_1_T-1.xml");
  ASSERT_TRUE(problem.world.goal->latest_s());
  const double reach_m =
      most_driven_m(problem.scenario.start_speed_mps, *problem.world.goal->latest_s());
  EXPECT_LT(reach_m + 1.0, nearest_goal_m(problem));
}

TEST(Unsolvable, ZamTutorialStatesNoGoal) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  EXPECT_TRUE(problem_named(folder, "ZAM_Tutorial-1_2_T-1.xml").world.goal->states.empty());
}

}  // namespace
}  // namespace roadbed::tools
