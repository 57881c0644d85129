#include "roadbed/geometry/primitives/pose2.h"

#include <gtest/gtest.h>

namespace roadbed::geometry {
namespace {

TEST(Pose2, PutsAPointLeftOfAVehicleThatFacesNorthToTheWest) {
  const Pose2 map_from_vehicle{10.0, 20.0, 0.5 * 3.14159265358979323846};
  const Eigen::Vector2d left_in_map = map_from_vehicle * Eigen::Vector2d(0.0, 2.0);
  EXPECT_NEAR(left_in_map.x(), 8.0, 1e-12);
  EXPECT_NEAR(left_in_map.y(), 20.0, 1e-12);
}

TEST(Pose2, InverseUndoesTheMotion) {
  const Pose2 a_from_b{3.0, -4.0, 2.2};
  const Eigen::Vector2d point(1.5, -0.5);
  EXPECT_NEAR((a_from_b.inverse() * (a_from_b * point) - point).norm(), 0.0, 1e-12);
}

TEST(Pose2, CompositionAppliesTheRightMotionFirst) {
  const Pose2 a_from_b{3.0, -4.0, 2.2}, b_from_c{-1.0, 0.5, -0.7};
  const Eigen::Vector2d point(1.5, -0.5);
  EXPECT_NEAR(((a_from_b * b_from_c) * point - a_from_b * (b_from_c * point)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace roadbed::geometry
