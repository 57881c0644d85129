#include "roadbed/geometry/motion/vehicle_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace roadbed::geometry {
namespace {

TEST(VehicleShape, CirclesCoverTheWholeRectangle) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  for (int count = 1; count <= 6; ++count) {
    const VehicleShape shape;
    const CoveringCircles circles = covering_circles(shape, count);
    double farthest = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector2d point(-shape.rear_overhang_m + fraction(random) * shape.length_m,
                                  (fraction(random) - 0.5) * shape.width_m);
      double nearest = 1e9;
      for (const double x_m : circles.centres_x_m) {
        nearest = std::min(nearest, (point - Eigen::Vector2d(x_m, 0.0)).norm());
      }
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, circles.radius_m);
    EXPECT_GT(farthest, 0.95 * circles.radius_m);  // no larger than needed
  }
}

TEST(VehicleShape, ReachIsTheFarthestCorner) {
  const VehicleShape shape;
  double farthest = 0.0;
  for (const auto& corner : shape.corners_in_vehicle())
    farthest = std::max(farthest, corner.norm());
  EXPECT_NEAR(shape.reach_m(), farthest, 1e-12);
}

TEST(VehicleShape, RefusesLengthsThatCannotBe) {
  EXPECT_NO_THROW(VehicleShape{}.check());
  EXPECT_THROW(VehicleShape{.width_m = 0.0}.check(), std::invalid_argument);
  EXPECT_THROW(VehicleShape{.wheelbase_m = -2.5}.check(), std::invalid_argument);
  EXPECT_THROW(VehicleShape{.wheelbase_m = 4.0}.check(), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
