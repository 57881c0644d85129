#include "roadbed/geometry/motion/rectangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace roadbed::geometry {
namespace {

Rectangle random_rectangle(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-5.0, 5.0), angle(-4.0, 4.0), half(0.2, 3.0);
  const double turn = angle(random);
  return {.centre = {place(random), place(random)},
          .axis = {std::cos(turn), std::sin(turn)},
          .half_length_m = half(random),
          .half_width_m = half(random)};
}

bool holds(const Rectangle& r, const Eigen::Vector2d& point) {
  const Eigen::Vector2d offset = point - r.centre;
  const double across = r.axis.x() * offset.y() - r.axis.y() * offset.x();
  return std::abs(offset.dot(r.axis)) <= r.half_length_m && std::abs(across) <= r.half_width_m;
}

// Points on the outline, `step` apart at most.
std::vector<Eigen::Vector2d> outline(const Rectangle& r, double step) {
  std::vector<Eigen::Vector2d> points;
  const auto corners = r.corners();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = corners[i], b = corners[(i + 1) % 4];
    const int count = static_cast<int>(std::ceil((b - a).norm() / step));
    for (int k = 0; k < count; ++k) points.push_back(a + (b - a) * k / count);
  }
  return points;
}

TEST(Rectangle, DistanceIsThatOfDenselySampledOutlines) {
  std::mt19937 random(3);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const Rectangle a = random_rectangle(random), b = random_rectangle(random);
    double nearest = 1e300;
    bool overlap = false;
    const auto points_b = outline(b, 0.05);
    for (const auto& p : outline(a, 0.05)) {
      overlap = overlap || holds(b, p);
      for (const auto& q : points_b) {
        nearest = std::min(nearest, (p - q).norm());
        overlap = overlap || holds(a, q);
      }
    }
    const double distance = distance_m(a, b);
    if (overlap) {
      EXPECT_EQ(distance, 0.0);
    } else {
      ++apart;
      EXPECT_LE(distance, nearest + 1e-12);
      EXPECT_GE(distance, nearest - 0.05);
    }
    EXPECT_NEAR(distance, distance_m(b, a), 1e-12);
  }
  EXPECT_GT(apart, 80);
}

TEST(Rectangle, CrossedOnesOverlapThoughNoCornerIsInside) {
  const Rectangle a{{0, 0}, {1, 0}, 5.0, 0.5}, b{{0, 0}, {0, 1}, 5.0, 0.5};
  EXPECT_EQ(distance_m(a, b), 0.0);
}

TEST(Rectangle, BodyReachesFromRearOverhangToFront) {
  const VehicleShape shape;
  const Rectangle body = body_at({1.0, 2.0, 0.5 * std::numbers::pi}, shape);
  const auto corners = body.corners();
  const Pose2 map_from_vehicle{1.0, 2.0, 0.5 * std::numbers::pi};
  const auto expected = shape.corners_in_vehicle();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR((corners[i] - map_from_vehicle * expected[i]).norm(), 0.0, 1e-12);
  }
}

TEST(Rectangle, DistanceToAPointIsZeroInsideAndEuclideanAtCorners) {
  const Rectangle r{{1, 1}, {0, 1}, 2.0, 1.0};
  EXPECT_EQ(distance_m(r, {1.9, 2.9}), 0.0);
  EXPECT_NEAR(distance_m(r, {5.0, 7.0}), 5.0, 1e-12);
  EXPECT_NEAR(distance_m(r, {1.0, -2.5}), 1.5, 1e-12);
}

constexpr VehicleShape kCar{.length_m = 4.0, .width_m = 2.0, .rear_overhang_m = 1.0};

// A small square at a place of the vehicle's frame, the vehicle anywhere.
std::string side_of(double x_m, double y_m, const Pose2& pose, double half_m = 0.05) {
  const Eigen::Vector2d at = pose * Eigen::Vector2d(x_m, y_m);
  return std::string(
      side_towards(Rectangle{.centre = at, .half_length_m = half_m, .half_width_m = half_m},
                   body_at(pose, kCar)));
}

TEST(SideTowards, NamesSidesAndCornersWhereverTheVehicleStands) {
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

TEST(SideTowards, OfALongThingTheNearestPlaceCounts) {
  // A lorry alongside: its middle is far ahead, yet it is nearest to the side.
  const Rectangle lorry{.centre = {10.0, 2.5}, .half_length_m = 9.0, .half_width_m = 1.0};
  EXPECT_EQ(side_towards(lorry, body_at({0, 0, 0}, kCar)), "left side");
}

}  // namespace
}  // namespace roadbed::geometry
