#include "roadbed/control/sampled_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "roadbed/control/tracking_run.h"

namespace roadbed::control {
namespace {

struct Bend {
  double largest_per_m = 0.0, turned_rad = 0.0, turned_either_way_rad = 0.0;
};

/// Curvature as change of heading, over steps of a metre.
Bend bend_of(const SampledPath& path) {
  Bend bend;
  for (double s_m = 0.0; s_m + 1.0 < path.length_m(); s_m += 1.0) {
    const double turn = path.at(s_m + 1.0).heading_rad - path.at(s_m).heading_rad;
    bend.largest_per_m = std::max(bend.largest_per_m, std::abs(turn));
    bend.turned_rad += turn;
    bend.turned_either_way_rad += std::abs(turn);
  }
  return bend;
}

TEST(PaperPaths, TurnAsFarAsTheySay) {
  const Bend right = bend_of(right_turn_path(5.0)), zig_zag = bend_of(zig_zag_path(5.0));
  EXPECT_NEAR(right.turned_rad, -0.5 * std::numbers::pi, 1e-3);
  EXPECT_NEAR(zig_zag.turned_rad, 0.0, 1e-3);
  EXPECT_NEAR(zig_zag.turned_either_way_rad, std::numbers::pi / 0.9, 0.05);  // 20° + 4 · 40° + 20°
  EXPECT_NEAR(right.largest_per_m, 0.113, 0.003);  // the gentle gaps' own peak
}

TEST(PaperPaths, LateralAccelerationStaysWithinThreeMetresPerSecondSquared) {
  for (const double speed : {5.0, 10.0, 20.0, 30.0}) {
    for (const SampledPath& path : {right_turn_path(speed), zig_zag_path(speed)}) {
      const double lateral = speed * speed * bend_of(path).largest_per_m;
      EXPECT_LT(lateral, 3.05) << speed << " m/s";
      EXPECT_GT(lateral, speed > 5.0 ? 2.8 : 0.5) << speed << " m/s";
    }
  }
  EXPECT_THROW(right_turn_path(0.0), std::invalid_argument);
  EXPECT_THROW(zig_zag_path(-1.0), std::invalid_argument);
}

TEST(PaperPaths, AreTrackedWithinACentimetreFromFiveToThirtyMetresPerSecond) {
  for (const double speed : {5.0, 10.0, 15.0, 20.0, 25.0, 30.0}) {
    for (const SampledPath& path : {right_turn_path(speed), zig_zag_path(speed)}) {
      const TrackingSummary run = summarise(track_path(path, {.speed_mps = speed}));
      EXPECT_LT(run.largest_cross_track_m, 0.01) << speed << " m/s";
      EXPECT_LT(run.largest_steering_rate_radps, 0.2) << speed << " m/s";
      EXPECT_LT(run.largest_lateral_jerk_mps3, 7.0) << speed << " m/s";
    }
  }
}

}  // namespace
}  // namespace roadbed::control
