#include "roadbed/planning/obstacles/road_border.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

double excess_m(const RoadBorder& border, const geometry::Pose2& pose, double near_s_m) {
  const geometry::VehicleShape vehicle;
  return border.excess_m(geometry::body_at(pose, vehicle), vehicle.rear_overhang_m, near_s_m);
}

TEST(RoadBorder, BesideACircleIsThatOfTheDistanceToItsCentre) {
  const double radius_m = 15.0;
  const tests::AnalyticLine circle{
      .curvature = {1.0 / radius_m, 0, 0, 0, 0}, .left_m = 2.5, .right_m = 4.0};
  const RoadBorder border(circle.view(), -5.0, 40.0);
  std::mt19937 random(23);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const geometry::VehicleShape vehicle;
  for (int i = 0; i < 1000; ++i) {
    const double s_m = 15.0 + 14.0 * unit(random), d_m = 4.0 * unit(random);
    const ReferencePoint at = circle.at(s_m);
    const geometry::Pose2 pose{at.in_map.x() - d_m * std::sin(at.heading_rad),
                               at.in_map.y() + d_m * std::cos(at.heading_rad),
                               at.heading_rad + 0.4 * unit(random)};
    double expected_m = -1e300;
    for (const Eigen::Vector2d& corner : vehicle.corners_in_vehicle()) {
      const Eigen::Vector2d point = pose * corner;
      const double corner_d_m = radius_m - (point - Eigen::Vector2d(0.0, radius_m)).norm();
      expected_m = std::max({expected_m, corner_d_m - 2.5, -corner_d_m - 4.0});
    }
    EXPECT_NEAR(excess_m(border, pose, s_m), expected_m, 1e-3);
  }
}

TEST(RoadBorder, SeesAFrontThatSwingsOutAheadOfTheRearAxle) {
  tests::AnalyticLine straight{.left_m = 2.0, .right_m = 2.0};
  const RoadBorder border(straight.view(), -5.0, 40.0);
  // The rear axle is on the line, the front 3.68 m ahead and turned to the left.
  EXPECT_LT(excess_m(border, {10.0, 0.0, 0.0}, 10.0), 0.0);
  EXPECT_GT(excess_m(border, {10.0, 0.0, 0.4}, 10.0), 0.1);
  EXPECT_GT(excess_m(border, {10.0, 0.0, -0.4}, 10.0), 0.1);
}

TEST(RoadBorder, FollowsEdgesThatCloseIn) {
  const tests::AnalyticLine straight;
  const auto view = straight.view();
  const LineView narrowing([view](double s_m) { return view.at(s_m); },
                           [](double s_m) {
                             return Corridor{3.0 - 0.1 * s_m, 3.0, 10.0};
                           });
  const RoadBorder border(narrowing, -5.0, 40.0);
  const geometry::VehicleShape vehicle;
  const double front_s_m = 12.0 + vehicle.front_m();
  EXPECT_NEAR(excess_m(border, {12.0, 0.5, 0.0}, 12.0),
              0.5 + 0.5 * vehicle.width_m - (3.0 - 0.1 * front_s_m), 1e-9);
}

}  // namespace
}  // namespace roadbed::planning
