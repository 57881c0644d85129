#include "roadbed/geometry/polygons/convex_overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/tests/support/brute_force_distance.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

Rectangle any_rectangle(std::mt19937& random, double spread_m) {
  std::uniform_real_distribution<double> place(-spread_m, spread_m), turn(-3.2, 3.2),
      half(0.2, 2.0);
  const double angle_rad = turn(random);
  return {.centre = {place(random), place(random)},
          .axis = {std::cos(angle_rad), std::sin(angle_rad)},
          .half_length_m = half(random),
          .half_width_m = half(random)};
}

Ring ring_of(const Rectangle& rectangle) {
  const auto corners = rectangle.corners();
  return {corners.begin(), corners.end()};
}

bool holds(const Rectangle& rectangle, const Vector2d& point) {
  const Vector2d off = point - rectangle.centre;
  return std::abs(off.dot(rectangle.axis)) <= rectangle.half_length_m &&
         std::abs(off.x() * rectangle.axis.y() - off.y() * rectangle.axis.x()) <=
             rectangle.half_width_m;
}

// Of points on a fine grid that both hold.
double area_by_points_m2(const Rectangle& a, const Rectangle& b) {
  constexpr double apart_m = 0.01;
  int both = 0;
  for (double x = -3.0; x < 3.0; x += apart_m) {
    for (double y = -3.0; y < 3.0; y += apart_m) {
      const Vector2d point = a.centre + Vector2d(x, y);
      both += holds(a, point) && holds(b, point);
    }
  }
  return both * apart_m * apart_m;
}

tests::Quad quad_of(const Rectangle& rectangle) { return rectangle.corners(); }

TEST(ConvexOverlap, HasTheAreaThatPointsInBothHave) {
  std::mt19937 random(11);
  for (int i = 0; i < 40; ++i) {
    const Rectangle a = any_rectangle(random, 1.0), b = any_rectangle(random, 1.0);
    EXPECT_NEAR(convex_overlap(ring_of(a), ring_of(b)).area_m2, area_by_points_m2(a, b), 0.04);
  }
}

TEST(ConvexOverlap, IsPartedByMovingAsFarAsItIsDeepAndByNothingLess) {
  std::mt19937 random(12);
  int overlapping = 0;
  for (int i = 0; i < 300; ++i) {
    const Rectangle a = any_rectangle(random, 2.0), b = any_rectangle(random, 2.0);
    const double depth_m = convex_overlap(ring_of(a), ring_of(b)).depth_m;
    const bool do_meet = tests::quad_distance(quad_of(a), quad_of(b)) == 0.0;
    EXPECT_EQ(depth_m > 0.0, do_meet) << i;
    if (!do_meet) continue;
    ++overlapping;
    const auto is_parted_by = [&](double way_m) {
      constexpr int directions = 3600;
      for (int k = 0; k < directions; ++k) {
        const double angle_rad = 2.0 * std::numbers::pi * k / directions;
        Rectangle moved = b;
        moved.centre += way_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
        if (tests::quad_distance(quad_of(a), quad_of(moved)) > 0.0) return true;
      }
      return false;
    };
    EXPECT_TRUE(is_parted_by(depth_m + 1e-4)) << i;
    EXPECT_FALSE(is_parted_by(depth_m - 1e-4)) << i;
  }
  EXPECT_GT(overlapping, 100);
}

TEST(ConvexOverlap, OfShapesThatOnlyTouchIsNothing) {
  const Ring square{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, beside{{1, 0}, {2, 0}, {2, 1}, {1, 1}};
  EXPECT_EQ(convex_overlap(square, beside).depth_m, 0.0);
  EXPECT_EQ(convex_overlap(square, beside).area_m2, 0.0);
}

TEST(ConvexOverlap, OfOneInTheOtherIsTheWayOutAndTheInnersArea) {
  const Ring outer{{0, 0}, {4, 0}, {4, 2}, {0, 2}}, inner{{1, 1}, {1.5, 1}, {1.5, 1.5}, {1, 1.5}};
  EXPECT_NEAR(convex_overlap(outer, inner).depth_m, 1.0, 1e-12);  // up, past y = 2
  EXPECT_NEAR(convex_overlap(inner, outer).area_m2, 0.25, 1e-12);
}

}  // namespace
}  // namespace roadbed::geometry
