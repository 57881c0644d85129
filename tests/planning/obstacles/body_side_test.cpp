#include "roadbed/planning/obstacles/body_side.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace roadbed::planning {
namespace {

using geometry::Pose2;
using geometry::Rectangle;
using geometry::VehicleShape;

constexpr VehicleShape kCar{.length_m = 4.0, .width_m = 2.0, .rear_overhang_m = 1.0};

// A small square at a place of the vehicle's frame, the vehicle anywhere.
std::string side_of(double x_m, double y_m, const Pose2& pose, double half_m = 0.05) {
  const Eigen::Vector2d at = pose * Eigen::Vector2d(x_m, y_m);
  return std::string(
      side_towards(Rectangle{.centre = at, .half_length_m = half_m, .half_width_m = half_m},
                   geometry::body_at(pose, kCar)));
}

TEST(BodySide, NamesSidesAndCornersWhereverTheVehicleStands) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-50.0, 50.0);
  for (int round = 0; round < 100; ++round) {
    const Pose2 pose{place(random), place(random), place(random)};
    EXPECT_EQ(side_of(4.0, 0.3, pose), "front");
    EXPECT_EQ(side_of(-2.0, -0.3, pose), "rear");
    EXPECT_EQ(side_of(1.0, 2.0, pose), "left side");
    EXPECT_EQ(side_of(1.0, -2.0, pose), "right side");
    EXPECT_EQ(side_of(4.0, 2.0, pose), "front left corner");
    EXPECT_EQ(side_of(4.0, -2.0, pose), "front right corner");
    EXPECT_EQ(side_of(-2.0, 2.0, pose), "rear left corner");
    EXPECT_EQ(side_of(-2.0, -2.0, pose), "rear right corner");
    EXPECT_EQ(side_of(2.95, 0.0, pose), "front");        // overlaps the front
    EXPECT_EQ(side_of(1.0, -0.95, pose), "right side");  // overlaps the side
  }
}

TEST(BodySide, OfALongThingTheNearestPlaceCounts) {
  // A lorry alongside: its middle is far ahead, yet it is nearest to the side.
  const Rectangle lorry{.centre = {10.0, 2.5}, .half_length_m = 9.0, .half_width_m = 1.0};
  EXPECT_EQ(side_towards(lorry, geometry::body_at({0, 0, 0}, kCar)), "left side");
}

}  // namespace
}  // namespace roadbed::planning
