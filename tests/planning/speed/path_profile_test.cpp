#include "roadbed/planning/speed/path_profile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbed::planning {
namespace {

/// On a circle to the right, with a step of the curvature at its end.
PathProfile circle(double radius_m) {
  PathProfile profile;
  for (int i = 0; i < 20; ++i) {
    profile.ahead_m.push_back(0.5 * i);
    profile.curvature_per_m.push_back(i < 15 ? -1.0 / radius_m : 1.0 / radius_m);
  }
  return profile;
}

TEST(PathProfile, TakesBendsAsFastAsTheLimitThatWasSetLast) {
  PathProfile profile = circle(20.0);
  for (const double limit_mps2 : {3.2, 3.7, 2.0}) {
    limit_speed_in_bends(profile, {}, {.max_lateral_acceleration_mps2 = limit_mps2});
    ASSERT_EQ(profile.most_mps.size(), profile.ahead_m.size());
    EXPECT_NEAR(profile.most_mps[5], std::sqrt(limit_mps2 * 20.0), 1e-9);
  }
}

TEST(PathProfile, TakesStepsOfTheCurvatureAsFastAsTheWheelsTurn) {
  PathProfile profile = circle(20.0);
  const geometry::VehicleShape vehicle;
  limit_speed_in_bends(profile, vehicle, {.steering_rate_fraction = 0.85});
  const double turn = vehicle.wheelbase_m / 20.0;  // tan of the steering angle
  const double steered_per_m = vehicle.wheelbase_m * (0.1 / 1.0) / (1.0 + turn * turn);
  EXPECT_NEAR(profile.most_mps[15], 0.85 * vehicle.max_steering_rate_radps / steered_per_m, 1e-9);
}

}  // namespace
}  // namespace roadbed::planning
