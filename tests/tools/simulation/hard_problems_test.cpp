// CommonRoad problems that ask for more than keeping to one lane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {
namespace {

/// The way along a path that leaves the middle of a road of 4 m by `slope`.
planning::PathProfile leaving_way(const World& world, double slope, double from_d_m) {
  const Scenario scenario;
  const planning::PlannedPath path(world.line, [=](double s_m) {
    return planning::LateralState{.s_m = s_m, .d_m = from_d_m + slope * s_m, .d_slope = slope};
  });
  return sample_path_profile(path, 0.0, 60.0,
                             ceiling_of(world.line, scenario.vehicle, scenario.options),
                             scenario.vehicle);
}

TEST(OnRoad, WayEndsBeforeTheFirstCornerLeavesTheRoad) {
  const World world = tests::straight_world({.width_m = 4.0}, {});
  const geometry::VehicleShape vehicle;
  const double slope = 0.05;
  // The left front corner: d + front · slope + half the width = 2 m, nearly.
  const double left_m = (2.0 - 0.5 * vehicle.width_m - vehicle.front_m() * slope) / slope;
  const double found_m = on_road_m(leaving_way(world, slope, 0.0), world.road_map);
  EXPECT_LT(found_m, left_m + 0.3);
  EXPECT_GT(found_m, left_m - 0.6);
}

TEST(OnRoad, WayThatStaysOrBeginsBesideTheRoadAndReturnsHasNoEnd) {
  const World world = tests::straight_world({.width_m = 4.0}, {});
  EXPECT_TRUE(std::isinf(on_road_m(leaving_way(world, 0.0, 0.0), world.road_map)));
  EXPECT_TRUE(std::isinf(on_road_m(leaving_way(world, -0.04, 1.6), world.road_map)));
}

Drive driven(const std::filesystem::path& real, const std::string& name) {
  CommonRoadDrive problem =
      read_common_road_drive(real / "commonroad/CommonRoad+commonroad-reachable-set" / name);
  return drive(problem.scenario, problem.world);
}

TEST(HardProblems, VehicleStopsBeforeATurnInWhichItWouldLeaveTheRoad) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const Drive drive = driven(folder, "BEL_Aarschot-3_1_T-1.xml");
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  const auto& worst = std::ranges::max(drive.samples, {}, &DriveSample::off_road_m);
  EXPECT_EQ(worst.off_road_m, 0.0) << worst.t_s;
}

TEST(HardProblems, OtherLaneThatLeadsToTheGoalIsTakenWhereTheOwnIsBlocked) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const Drive drive = driven(folder, "ZAM_Zip-1_6_T-1.xml");
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
}

// Out, in and out again ahead of who comes from behind; round what stands 24 m ahead at 20 m/s.
TEST(HardProblems, DriveIsSearchedWhereNoPathBesideTheLineIsAnyGood) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  for (const char* name : {"ESP_Ceuta-5_1_T-1.xml", "ZAM_Over-1_1.xml"}) {
    const Drive drive = driven(folder, name);
    EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << name << drive.verdict.text;
    const auto& worst = std::ranges::max(drive.samples, {}, &DriveSample::off_road_m);
    EXPECT_EQ(worst.off_road_m, 0.0) << name << worst.t_s;
  }
}

}  // namespace
}  // namespace roadbed::tools
