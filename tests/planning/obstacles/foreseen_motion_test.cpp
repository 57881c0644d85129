#include "roadbed/planning/obstacles/foreseen_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace roadbed::planning {
namespace {

// Foreseen for 12 s of one who drives at 8 m/s a bend of 100 m radius and speeds up by 2 m/s².
const geometry::Trajectory kForeseen = foreseen_motion({.t_s = 3.0,
                                                        .pose = {5.0, 0.0, 0.0},
                                                        .speed_mps = 8.0,
                                                        .acceleration_mps2 = 2.0,
                                                        .curvature_per_m = 0.01});

TEST(SpeedingOn, GoesTheSameWayAsFarAsItsAccelerationTakesIt) {
  const geometry::Trajectory faster = speeding_on(kForeseen, 3.0).value();
  double way_m = 0.0;
  for (double t_s = 3.0; t_s < 3.0 + 8.0; t_s += 0.01) {
    const auto from = faster.at(t_s), to = faster.at(t_s + 0.01);
    way_m += std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    const double after_s = t_s + 0.01 - 3.0, speeds_up_s = std::min(after_s, 4.0);
    const double then_m = 8.0 * after_s + 2.0 * speeds_up_s * (after_s - 0.5 * speeds_up_s);
    EXPECT_NEAR(way_m, then_m, 0.05) << after_s << " s";
    EXPECT_NEAR(to.speed_mps, 8.0 + 2.0 * speeds_up_s, 0.1) << after_s << " s";
  }
  for (const geometry::TrajectoryPoint& point : faster.points()) {
    double nearest_m = 1e9;
    for (double t_s = 3.0; t_s <= kForeseen.end_s(); t_s += 0.01) {
      const auto at = kForeseen.at(t_s);
      nearest_m = std::min(nearest_m, std::hypot(at.x_m - point.x_m, at.y_m - point.y_m));
    }
    EXPECT_LT(nearest_m, 0.06) << point.t_s;
  }
}

TEST(SpeedingOn, IsOfNobodyWhoKeepsItsSpeedBrakesOrStands) {
  for (const double acceleration_mps2 : {0.4, 0.0, -2.0}) {
    EXPECT_FALSE(speeding_on(
        foreseen_motion({.pose = {}, .speed_mps = 8.0, .acceleration_mps2 = acceleration_mps2}),
        0.0));
  }
  EXPECT_FALSE(speeding_on(foreseen_motion({.pose = {1.0, 2.0, 3.0}}), 0.0));
}

TEST(SpeedingOn, SetsOffFromRest) {
  const geometry::Trajectory sets_off({{.t_s = 0.0},
                                       {.t_s = 1.0, .x_m = 0.5, .speed_mps = 1.0},
                                       {.t_s = 20.0, .x_m = 19.5, .speed_mps = 1.0}});
  const geometry::Trajectory faster = speeding_on(sets_off, 0.0).value();
  EXPECT_NEAR(faster.end_s(), 4.0 + (19.5 - 8.0) / 4.0, 1e-9);
}

}  // namespace
}  // namespace roadbed::planning
