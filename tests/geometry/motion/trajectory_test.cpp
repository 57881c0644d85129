#include "roadbed/geometry/motion/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbed::geometry {
namespace {

TEST(Trajectory, HeadingIsUnwrappedSoThatAMeanIsBetween) {
  const Trajectory drive({{.t_s = 0.0, .heading_rad = 3.1}, {.t_s = 1.0, .heading_rad = -3.1}});
  EXPECT_NEAR(drive.at(0.5).heading_rad, 3.14159265358979, 1e-12);
}

TEST(Trajectory, EveryFieldIsLinearBetweenRows) {
  const Trajectory drive(
      {{0.0, 1.0, 2.0, 0.1, 4.0, 0.5, 0.01, 0.02}, {2.0, 3.0, 6.0, 0.5, 8.0, 1.5, 0.03, 0.06}});
  const TrajectoryPoint at = drive.at(0.5);
  EXPECT_NEAR(at.x_m, 1.5, 1e-12);
  EXPECT_NEAR(at.y_m, 3.0, 1e-12);
  EXPECT_NEAR(at.heading_rad, 0.2, 1e-12);
  EXPECT_NEAR(at.speed_mps, 5.0, 1e-12);
  EXPECT_NEAR(at.acceleration_mps2, 0.75, 1e-12);
  EXPECT_NEAR(at.steering_rad, 0.015, 1e-12);
  EXPECT_NEAR(at.curvature_per_m, 0.03, 1e-12);
}

TEST(Trajectory, TimeBeyondTheEndsIsClamped) {
  const Trajectory drive({{.t_s = 1.0, .x_m = 1.0}, {.t_s = 2.0, .x_m = 5.0}});
  EXPECT_EQ(drive.at(0.0).x_m, 1.0);
  EXPECT_EQ(drive.at(9.0).x_m, 5.0);
}

TEST(Trajectory, RefusesTimeThatDoesNotIncrease) {
  EXPECT_THROW(Trajectory({{.t_s = 1.0}, {.t_s = 1.0}}), std::invalid_argument);
  EXPECT_THROW(Trajectory(std::vector<TrajectoryPoint>{}), std::invalid_argument);
  EXPECT_THROW(Trajectory({{.t_s = 0.0, .x_m = std::nan("")}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
