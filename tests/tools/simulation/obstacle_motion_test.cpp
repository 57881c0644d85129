#include "roadbed/tools/simulation/obstacle_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace roadbed::tools {
namespace {

const std::vector<TimedSpeed> kBraking{{2.0, 10.0}, {6.0, 0.0}};

Way along_x() {
  return [](double distance_m) { return geometry::Pose2{distance_m, 0.0, 0.0}; };
}

TEST(ObstacleMotion, DistanceIsTheIntegralOfTheSpeed) {
  EXPECT_NEAR(travelled_m(kBraking, 1.0), 10.0, 1e-12);
  EXPECT_NEAR(travelled_m(kBraking, 4.0), 20.0 + 0.5 * (10.0 + 5.0) * 2.0, 1e-12);
  EXPECT_NEAR(travelled_m(kBraking, 6.0), 40.0, 1e-12);
  EXPECT_NEAR(travelled_m(kBraking, 100.0), 40.0, 1e-12);
  // The oracle: many small steps.
  const std::vector<TimedSpeed> speeds{{0.0, 3.0}, {0.33, 7.0}, {1.11, 2.0}, {2.0, 2.5}};
  const double dt = 1e-5;
  double sum = 0.0;
  for (int k = 0; k < 150'000; ++k) {
    sum += travelled_m(speeds, dt * (k + 1)) - travelled_m(speeds, dt * k);
  }
  EXPECT_NEAR(travelled_m(speeds, 1.5), sum, 1e-9);
  EXPECT_NEAR((travelled_m(speeds, 0.2 + dt) - travelled_m(speeds, 0.2)) / dt,
              3.0 + 4.0 * 0.2 / 0.33, 1e-3);
}

TEST(ObstacleMotion, DrivesWithItsSpeedsAndRestsAtTheEndOfItsWay) {
  const geometry::Trajectory motion = drive_along(along_x(), 30.0, kBraking, 8.0);
  EXPECT_EQ(motion.end_s(), 8.0);
  EXPECT_NEAR(motion.at(1.0).x_m, 10.0, 1e-9);
  EXPECT_NEAR(motion.at(1.0).speed_mps, 10.0, 1e-9);
  EXPECT_NEAR(motion.at(3.0).speed_mps, 7.5, 1e-9);
  EXPECT_EQ(motion.at(8.0).x_m, 30.0);
  EXPECT_EQ(motion.at(8.0).speed_mps, 0.0);
}

TEST(ObstacleMotion, ScriptedPosesAreMetAtTheirTimes) {
  const double pi = std::numbers::pi;
  const geometry::Trajectory motion =
      drive_through({{1.0, {0, 0, pi - 0.1}}, {3.0, {6, 8, -pi + 0.1}}});
  EXPECT_NEAR(motion.at(2.0).x_m, 3.0, 1e-12);
  EXPECT_NEAR(motion.at(2.0).heading_rad, pi, 1e-12);  // the shorter way round
  EXPECT_NEAR(motion.at(1.0).speed_mps, 5.0, 1e-12);
  EXPECT_NEAR(motion.at(0.0).x_m, 0.0, 1e-12);
  EXPECT_NEAR(motion.at(9.0).x_m, 6.0, 1e-12);
}

TEST(ObstacleMotion, ScriptedSpeedIsTheRateAtWhichThePlaceChanges) {
  const geometry::Trajectory motion =
      drive_through({{0.0, {0, 0, 0}}, {2.0, {10, 0, 0}}, {2.5, {10, 4, 1}}, {6.0, {10, 4, 1}}});
  for (double t = 0.05; t < 7.0; t += 0.1) {
    const Eigen::Vector2d moved =
        motion.at(t + 0.01).pose().position() - motion.at(t - 0.01).pose().position();
    EXPECT_NEAR(motion.at(t).speed_mps, moved.norm() / 0.02, 1e-9) << t << " s";
  }
}

}  // namespace
}  // namespace roadbed::tools
