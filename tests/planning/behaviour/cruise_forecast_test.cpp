#include "roadbed/planning/behaviour/cruise_forecast.h"

#include <gtest/gtest.h>

#include <utility>

#include "roadbed/tests/support/straight_profile.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kMargin_m = 0.1;

planning::Obstacle moving(geometry::Pose2 from, double speed_mps) {
  planning::Obstacle other{.id = "other", .motion = {}};
  const geometry::Pose2 to = from * geometry::Pose2{20.0 * speed_mps, 0.0, 0.0};
  other.motion = drive_through({{0.0, from}, {20.0, to}});
  return other;
}

planning::CruiseForecast forecast(std::vector<planning::Obstacle> others, bool crosses,
                                  double stop_m = 1e3, int steps = 150) {
  const planning::PathProfile profile = tests::straight_profile(12.0, 12.0);
  const std::vector<bool> marks(others.size(), crosses), none(others.size(), false);
  const planning::StGraph occupancy(profile, {others}, 0.0, steps, kMargin_m);
  return planning::forecast_cruise({.profile = profile,
                                    .occupancy = occupancy,
                                    .speed_mps = 10.0,
                                    .stop_m = stop_m,
                                    .no_matter = none,
                                    .crosses = marks},
                                   {});
}

TEST(CruiseForecast, ClosesUpToALeadAtTheGapThatIsKeptAtItsSpeed) {
  const auto found = forecast({moving({60.0, 0.0, 0.0}, 6.0)}, false);
  EXPECT_FALSE(found.met);
  const planning::SpeedState& end = found.drive.plan.back();
  EXPECT_NEAR(end.t_s, 15.0, 1e-9);
  EXPECT_NEAR(end.speed_mps, 6.0, 0.3);
  // Centre to bumper 2.25 m, the vehicle's front, the margin, and at most a sample before.
  const double gap_m = 60.0 + 6.0 * 15.0 - 2.25 - end.ahead_m - geometry::VehicleShape{}.front_m();
  EXPECT_NEAR(gap_m, 5.0 + 1.5 * 6.0, 1.5);
}

TEST(CruiseForecast, NamesWhoIsMetAndWhenWhereSomebodyCrosses) {
  // On the path from 4.5 to 5.5 s, where the vehicle drives into its side, 0.9 m before x = 60 m.
  const auto found =
      forecast({moving({500.0, 0.0, 0.0}, 0.0), moving({60.0, -30.0, M_PI_2}, 6.0)}, true);
  ASSERT_EQ(found.met, 1U);
  EXPECT_FALSE(found.drive.is_free);
  const planning::SpeedState& end = found.drive.plan.back();
  EXPECT_NEAR(end.t_s, found.drive.free_until_s + 0.1, 1e-9);
  EXPECT_GT(end.t_s, 4.5);
  EXPECT_LT(end.t_s, 5.5);
  const double touches_m = 60.0 - 0.9 - kMargin_m - geometry::VehicleShape{}.front_m();
  EXPECT_NEAR(end.ahead_m, touches_m + 0.35, 0.85);  // a sample before, and a step of 1.2 m
}

TEST(CruiseForecast, ComesToRestWhereItHasToStop) {
  const auto found = forecast({}, false, 80.0, 200);
  EXPECT_TRUE(found.drive.is_free);
  EXPECT_NEAR(found.drive.plan.back().ahead_m, 80.0, 0.3);
  EXPECT_NEAR(found.drive.plan.back().speed_mps, 0.0, 0.1);
}

}  // namespace
}  // namespace roadbed::tools
