#include "roadbed/planning/lateral/planned_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::tools {
namespace {

using planning::LateralState;
using planning::ReferenceLine;

constexpr double kWheelbase = 2.6;

// A winding line, and an offset that swings about it.
ReferenceLine winding_line() {
  std::vector<Eigen::Vector2d> points;
  for (double x = 0.0; x <= 120.0; x += 2.0) points.emplace_back(x, 6.0 * std::sin(x / 15.0));
  return ReferenceLine::through(points, 4.0, 10.0);
}

LateralState swing(double s_m) {
  return {.s_m = s_m,
          .d_m = 1.2 * std::sin(0.15 * s_m),
          .d_slope = 1.2 * 0.15 * std::cos(0.15 * s_m),
          .d_curvature_per_m = -1.2 * 0.15 * 0.15 * std::sin(0.15 * s_m)};
}

class PlannedPathTest : public testing::Test {
 protected:
  const ReferenceLine line_ = winding_line();
  const planning::PlannedPath path_{line_, swing};
};

TEST_F(PlannedPathTest, HeadingIsTheDirectionInWhichItsPlacesMove) {
  for (double s = 5.0; s < 110.0; s += 1.7) {
    const double h = 1e-5;
    const Eigen::Vector2d move = path_.pose_at(s + h).position() - path_.pose_at(s - h).position();
    EXPECT_NEAR(
        std::remainder(std::atan2(move.y(), move.x()) - path_.pose_at(s).heading_rad, 2.0 * M_PI),
        0.0, 1e-6);
  }
}

TEST_F(PlannedPathTest, CurvatureIsTheTurnPerDistance) {
  for (double s = 5.0; s < 110.0; s += 1.7) {
    const double h = 1e-4;
    const geometry::Pose2 before = path_.pose_at(s - h), after = path_.pose_at(s + h);
    const double turn = after.heading_rad - before.heading_rad;
    EXPECT_NEAR(path_.curvature_per_m(s), turn / (after.position() - before.position()).norm(),
                1e-4);
  }
}

TEST_F(PlannedPathTest, FrontAxlePointsAlongItsOwnPath) {
  for (double s = 5.0; s < 110.0; s += 1.7) {
    const double h = 1e-4;
    const Eigen::Vector2d move = path_.front_pose_at(s + h, kWheelbase).position() -
                                 path_.front_pose_at(s - h, kWheelbase).position();
    const double heading = path_.front_pose_at(s, kWheelbase).heading_rad;
    EXPECT_NEAR(std::remainder(std::atan2(move.y(), move.x()) - heading, 2.0 * M_PI), 0.0, 1e-4);
  }
}

TEST_F(PlannedPathTest, FindsTheNearestPlaceOfTheFrontAxle) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(10.0, 100.0), aside(-0.8, 0.8), off(-2.0, 2.0);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const double s = place(random), d = aside(random);
    const Eigen::Vector2d point = path_.front_pose_at(s, kWheelbase) * Eigen::Vector2d(0.0, d);
    EXPECT_NEAR(path_.nearest_front_s_m(point, kWheelbase, s + off(random)), s, 1e-6);
  }
}

TEST_F(PlannedPathTest, LateralStateOfAVehicleOnThePathIsThatOfThePath) {
  for (double s = 5.0; s < 110.0; s += 1.7) {
    const LateralState found =
        lateral_state(line_, path_.pose_at(s), path_.curvature_per_m(s), s + 1.0);
    EXPECT_NEAR(found.s_m, s, 1e-3);
    EXPECT_NEAR(found.d_m, swing(s).d_m, 1e-3);
    EXPECT_NEAR(found.d_slope, swing(s).d_slope, 1e-3);
    EXPECT_NEAR(found.d_curvature_per_m, swing(s).d_curvature_per_m, 1e-3);
  }
}

}  // namespace
}  // namespace roadbed::tools
