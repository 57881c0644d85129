#include "roadbed/planning/lateral/maneuver_completion.h"

#include <gtest/gtest.h>

namespace roadbed::planning {
namespace {

// Along the x axis.
LineView axis() {
  return {[](double s_m) {
            return ReferencePoint{.s_m = s_m, .in_map = {s_m, 0.0}};
          },
          [](double) { return Corridor{}; }};
}

geometry::Trajectory passing(double speed_mps, double until_s) {
  const LineView line = axis();
  const LateralPath path = [](double s_m) { return LateralState{.s_m = s_m, .d_m = 1.0}; };
  const DrivenPath course{
      .line = line, .path = path, .vehicle = {}, .start_s_m = 10.0, .start_t_s = 100.0};
  return passing_drive(course, PlannedSpeed({.speed_mps = speed_mps, .target_mps = speed_mps}),
                       60.0, until_s);
}

TEST(PassingDrive, EndsAtTheStationOrPastTheTime) {
  const auto whole = passing(10.0, 60.0);
  EXPECT_NEAR(whole.points().back().x_m, 59.0, 1e-9);
  EXPECT_NEAR(whole.end_s(), 104.9, 1e-9);
  const auto cut = passing(10.0, 1.95);
  EXPECT_GT(cut.end_s(), 101.95);
  EXPECT_LT(cut.end_s(), 102.15);
  for (const auto& point : cut.points()) EXPECT_NEAR(point.y_m, 1.0, 1e-9);
}

TEST(PassingDrive, OfAVehicleThatStandsHasALegAsLongAsTheTime) {
  const auto standing = passing(0.0, 10.0);
  ASSERT_GE(standing.points().size(), 2u);
  EXPECT_GT(standing.end_s(), 110.0);
  EXPECT_LT(standing.at(110.0).x_m, 10.6);
}

}  // namespace
}  // namespace roadbed::planning
