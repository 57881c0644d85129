#include "roadbed/planning/speed/safe_way_on.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/control/lower_controller.h"
#include "roadbed/planning/speed/speed_search.h"
#include "roadbed/tests/support/straight_profile.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kHardBraking_mps2 = 8.0, kFar_m = 1e4, kMargin_m = 0.3;

/// Drives along the x axis; its centre is at `x_m` after 1 s.
planning::Obstacle moving(double x_m, double speed_mps) {
  planning::Obstacle other{.id = "other", .motion = {}};
  const auto at = [&](double t_s) {
    return geometry::Pose2{x_m + speed_mps * (t_s - 1.0), 0.0, speed_mps < 0.0 ? M_PI : 0.0};
  };
  other.motion = drive_through({{0.0, at(0.0)}, {10.0, at(10.0)}});
  return other;
}

/// Least distance between both while the vehicle brakes behind the lag of its actuator; who drives
/// ahead brakes as hard at once, who comes the other way does not.
double least_gap_m(double gap_m, const planning::SpeedState& own, double other_mps) {
  constexpr double kStep_s = 1e-3;
  double least_m = gap_m, speed_mps = own.speed_mps, acceleration_mps2 = own.acceleration_mps2;
  while (speed_mps > 0.0) {
    acceleration_mps2 = control::actuate(acceleration_mps2, -kHardBraking_mps2, kStep_s);
    speed_mps += acceleration_mps2 * kStep_s;
    if (other_mps > 0.0) other_mps = std::max(0.0, other_mps - kHardBraking_mps2 * kStep_s);
    gap_m += (other_mps - std::max(0.0, speed_mps)) * kStep_s;
    least_m = std::min(least_m, gap_m);
  }
  return least_m;
}

TEST(SafeWayOn, IsThereWhereBrakingEndsBeforeTheOther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x_m(10.0, 90.0), own_mps(0.0, 25.0), own_mps2(-8.0, 2.0),
      other_mps(-15.0, 20.0);
  int safe = 0, barred = 0;
  for (int i = 0; i < 400; ++i) {
    const planning::PathProfile profile = tests::straight_profile(12.0);
    const double x = x_m(random), other = other_mps(random);
    const planning::SpeedState own{
        .t_s = 1.0, .speed_mps = own_mps(random), .acceleration_mps2 = own_mps2(random)};
    const std::vector<planning::Obstacle> others{moving(x, other)};
    const planning::StGraph occupancy(profile, {others}, 0.0, 10, kMargin_m);
    const double gap_m = x - 2.25 - kMargin_m - geometry::VehicleShape{}.front_m();
    const double least_m = least_gap_m(gap_m, own, other);
    // A sample of the path, what counts as at rest, and what braking less at first may take.
    if (least_m > -0.6 && least_m < 1.6 + 0.3 * std::max(0.0, -other)) continue;
    const auto bars = who_bars_way_on(own, occupancy, kFar_m, {}, kHardBraking_mps2);
    EXPECT_EQ(bars.has_value(), least_m < 0.0)
        << x << " " << own.speed_mps << " " << own.acceleration_mps2 << " " << other;
    (bars ? barred : safe)++;
  }
  EXPECT_GT(safe, 50);
  EXPECT_GT(barred, 50);
}

TEST(SafeWayOn, EndsBeforeTheRoadDoes) {
  const planning::PathProfile profile = tests::straight_profile(12.0);
  const planning::StGraph nobody(profile, {}, 0.0, 10, kMargin_m);
  const double stop_m = 12.0 * geometry::kLongitudinal.actuator_lag_s + 72.0 / kHardBraking_mps2;
  const planning::SpeedState last{.t_s = 1.0, .ahead_m = 20.0, .speed_mps = 12.0};
  EXPECT_FALSE(who_bars_way_on(last, nobody, 20.0 + stop_m + 0.1));
  EXPECT_EQ(who_bars_way_on(last, nobody, 20.0 + stop_m - 0.2), planning::StInterval::kNoObstacle);
}

TEST(SafeWayOn, WhoIsIgnoredBarsNothing) {
  const planning::PathProfile profile = tests::straight_profile(12.0);
  const std::vector<planning::Obstacle> others{moving(12.0, 0.0)};
  const planning::StGraph occupancy(profile, {others}, 0.0, 10, kMargin_m);
  const planning::SpeedState last{.t_s = 1.0, .speed_mps = 15.0};
  EXPECT_EQ(who_bars_way_on(last, occupancy, kFar_m), 0u);
  EXPECT_FALSE(who_bars_way_on(last, occupancy, kFar_m, {true}));
}

TEST(SafeWayOn, EverySpeedThatIsFoundHasOneWhateverItsHorizon) {
  for (const double x_m : {35.0, 45.0, 60.0}) {
    for (const double horizon_s : {1.0, 1.5, 2.0, 3.0}) {
      const planning::PathProfile profile = tests::straight_profile(20.0);
      const std::vector<planning::Obstacle> others{moving(x_m, 0.0)};
      const planning::StGraph occupancy(profile, {others}, 0.0, 40, kMargin_m);
      const planning::SpeedSearchAnswer found =
          planning::search_speed({.profile = profile,
                                  .occupancy = occupancy,
                                  .speed_mps = 18.0,
                                  .horizon_s = horizon_s,
                                  .end_m = kFar_m,
                                  .goals = {}},
                                 {.least_mps2 = -kHardBraking_mps2});
      const planning::SpeedState& last = found.plan.back();
      const double gap_m =
          x_m - 2.25 - kMargin_m - geometry::VehicleShape{}.front_m() - last.ahead_m;
      ASSERT_TRUE(found.is_free) << x_m << " " << horizon_s;
      EXPECT_GT(least_gap_m(gap_m, last, 0.0), -0.6) << x_m << " " << horizon_s;
    }
  }
}

}  // namespace
}  // namespace roadbed::tools
