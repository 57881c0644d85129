#include "roadbed/planning/lateral/planned_speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace roadbed::planning {
namespace {

const std::vector<SpeedPlan> kPlans = {{10.0, 1.0, 13.0}, {10.0, -2.0, 5.0}, {10.0, -3.0, 0.0},
                                       {0.0, 1.5, 12.0},  {12.0, 0.3, 12.1}, {8.0, 0.0, 12.0},
                                       {8.0, -1.0, 12.0}, {8.0, 1.0, 5.0}};

TEST(PlannedSpeed, StartsAsThePlanSays) {
  for (const SpeedPlan& plan : kPlans) {
    const auto state = PlannedSpeed(plan).at(1e-9);
    EXPECT_NEAR(state.speed_mps, plan.speed_mps, 1e-4);
    EXPECT_NEAR(state.acceleration_mps2, plan.acceleration_mps2, 1e-6);
  }
}

TEST(PlannedSpeed, AccelerationAndJerkAreDerivativesInTime) {
  for (const SpeedPlan& plan : kPlans) {
    const PlannedSpeed profile(plan);
    for (double l = 0.7; l < 60.0; l += 1.3) {
      const auto at = profile.at(l);
      if (at.speed_mps < 0.5) continue;
      const double h = 1e-4;
      const auto before = profile.at(l - h), after = profile.at(l + h);
      // d/dt = v d/dl, but where the phases meet the jerk jumps.
      if ((before.jerk_mps3 == 0.0) != (after.jerk_mps3 == 0.0)) continue;
      EXPECT_NEAR(at.acceleration_mps2,
                  at.speed_mps * (after.speed_mps - before.speed_mps) / (2 * h), 1e-6);
      EXPECT_NEAR(at.jerk_mps3,
                  at.speed_mps * (after.acceleration_mps2 - before.acceleration_mps2) / (2 * h),
                  1e-5);
    }
  }
}

TEST(PlannedSpeed, ApproachesItsTargetWithoutPassingIt) {
  const PlannedSpeed faster({10.0, 1.0, 13.0}), slower({10.0, -2.0, 5.0});
  for (double l = 0.0; l < 200.0; l += 0.5) {
    EXPECT_LE(faster.at(l).speed_mps, 13.0);
    EXPECT_GE(slower.at(l).speed_mps, 5.0);
  }
  EXPECT_NEAR(faster.at(200.0).speed_mps, 13.0, 1e-3);
  EXPECT_NEAR(slower.at(200.0).speed_mps, 5.0, 1e-3);
}

TEST(PlannedSpeed, AwayFromItsTargetBrakesToAStop) {
  const PlannedSpeed braking({8.0, -1.0, 12.0});  // stops after v²/2a = 32 m
  EXPECT_NEAR(braking.at(31.0).speed_mps, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(braking.at(33.0).speed_mps, 0.0);
  EXPECT_EQ(braking.at(33.0).acceleration_mps2, 0.0);
}

TEST(PlannedSpeed, RefusesWhatIsNoSpeed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PlannedSpeed({-1.0, 0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(PlannedSpeed({1.0, 0.0, -1.0}), std::invalid_argument);
  EXPECT_THROW(PlannedSpeed({1.0, nan, 1.0}), std::invalid_argument);
}

// Samples of another plan, as a profile.
std::vector<SpeedSample> sampled(const PlannedSpeed& plan, double to_m, double step_m) {
  std::vector<SpeedSample> profile;
  for (double l = 0.0; l <= to_m + 1e-9; l += step_m) {
    const auto at = plan.at(l);
    profile.push_back({l, at.speed_mps, at.acceleration_mps2});
  }
  return profile;
}

TEST(PlannedSpeed, OfAProfileFollowsThePlanThatItWasSampledFrom) {
  for (const SpeedPlan& plan : kPlans) {
    const PlannedSpeed original(plan), profile(sampled(original, 40.0, 0.25));
    for (double l = 0.1; l < 40.0; l += 0.13) {
      const auto expected = original.at(l), found = profile.at(l);
      if (expected.speed_mps < 1.0) continue;  // between the last samples before it stands
      EXPECT_NEAR(found.speed_mps, expected.speed_mps, 2e-3);
      EXPECT_NEAR(found.acceleration_mps2, expected.acceleration_mps2, 0.05);
    }
  }
}

TEST(PlannedSpeed, OfAProfileHasDerivativesInTimeAndStandsWhereItStops) {
  const std::vector<SpeedSample> rows = {{0.0, 8.0, -1.0}, {9.0, 6.5, -2.0}, {19.5, 0.0, 0.0}};
  const PlannedSpeed profile(rows);
  for (double l = 0.3; l < 19.0; l += 0.7) {
    const auto at = profile.at(l);
    const double h = 1e-5;
    const auto before = profile.at(l - h), after = profile.at(l + h);
    if (l - h < 9.0 && l + h > 9.0) continue;
    EXPECT_NEAR(at.acceleration_mps2, at.speed_mps * (after.speed_mps - before.speed_mps) / (2 * h),
                1e-6);
    EXPECT_NEAR(at.jerk_mps3,
                at.speed_mps * (after.acceleration_mps2 - before.acceleration_mps2) / (2 * h),
                1e-5);
  }
  EXPECT_EQ(profile.at(25.0).speed_mps, 0.0);
  EXPECT_EQ(profile.at(-1.0).speed_mps, 8.0);
}

TEST(PlannedSpeed, RefusesProfilesThatCannotBeUsed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Rows = std::vector<SpeedSample>;
  for (const Rows& rows : {Rows{}, Rows{{0.0, -1.0, 0.0}}, Rows{{0.0, nan, 0.0}},
                           Rows{{1.0, 5.0, 0.0}, {1.0, 5.0, 0.0}}}) {
    EXPECT_THROW(PlannedSpeed{std::span<const SpeedSample>(rows)}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace roadbed::planning
