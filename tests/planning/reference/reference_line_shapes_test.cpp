// Shapes that way-points of real roads have: the line has no kink, no loop and bends no more than
// the shape asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;
using WayPoints = std::vector<Vector2d>;
constexpr double kPi = std::numbers::pi;

struct ShapeOfLine {
  double peak_curvature_per_m = 0.0, largest_jump_per_m = 0.0;
  double least_heading_rad = 1e9, most_heading_rad = -1e9;
};

// Looked at every centimetre; a jump is a change of curvature beyond what κ′ explains.
ShapeOfLine shape_of_line(const ReferenceLine& line) {
  constexpr double kApart_m = 0.01;
  ShapeOfLine shape;
  ReferencePoint last = line.at(0.0);
  for (double s_m = 0.0; s_m <= line.length_m(); s_m += kApart_m) {
    const ReferencePoint at = line.at(s_m);
    const double explained = 0.5 * (last.curvature_d1_per_m2 + at.curvature_d1_per_m2);
    shape.largest_jump_per_m =
        std::max(shape.largest_jump_per_m,
                 std::abs(at.curvature_per_m - last.curvature_per_m - explained * kApart_m));
    shape.peak_curvature_per_m = std::max(shape.peak_curvature_per_m, std::abs(at.curvature_per_m));
    shape.least_heading_rad = std::min(shape.least_heading_rad, at.heading_rad);
    shape.most_heading_rad = std::max(shape.most_heading_rad, at.heading_rad);
    last = at;
  }
  return shape;
}

void expect_no_kink_or_loop(const WayPoints& way_points, double peak_per_m, double least_rad,
                            double most_rad) {
  const ShapeOfLine shape = shape_of_line(ReferenceLine::through(way_points, 1.75, 10.0));
  EXPECT_LE(shape.largest_jump_per_m, 1e-4);
  EXPECT_LE(shape.peak_curvature_per_m, peak_per_m);
  EXPECT_GE(shape.least_heading_rad, least_rad - 0.12);
  EXPECT_LE(shape.most_heading_rad, most_rad + 0.12);
}

TEST(ReferenceLineShapes, UTurnOverTwoCorners) {
  expect_no_kink_or_loop({{0, 0}, {60, 0}, {60, 16}, {0, 16}}, 0.25, 0.0, kPi);
}

TEST(ReferenceLineShapes, UTurnOfAnArc) {
  WayPoints points{{-40, 0}, {-20, 0}};
  for (int i = 0; i <= 8; ++i) {
    const double angle = kPi * i / 8.0;
    points.push_back({8.0 * std::sin(angle), 8.0 - 8.0 * std::cos(angle)});
  }
  points.push_back({-20, 16});
  points.push_back({-40, 16});
  expect_no_kink_or_loop(points, 0.2, 0.0, kPi);
}

TEST(ReferenceLineShapes, SBend) {
  expect_no_kink_or_loop({{0, 0}, {30, 0}, {50, 20}, {80, 20}}, 0.1, 0.0, 0.25 * kPi);
}

TEST(ReferenceLineShapes, ShortLegBetweenTwoCorners) {
  // The line swings out a little, as far as it may leave the path.
  expect_no_kink_or_loop({{0, 0}, {20, 0}, {20, 3}, {40, 3}}, 1.6, -0.25, 0.5 * kPi);
}

TEST(ReferenceLineShapes, Roundabout) {
  WayPoints points{{-40, -15}};
  for (int i = 0; i <= 12; ++i) {  // three quarters of it, entered and left along tangents
    const double angle = -0.5 * kPi + 1.5 * kPi * i / 12.0;
    points.push_back({15.0 * std::cos(angle), 15.0 * std::sin(angle)});
  }
  points.push_back({-15, -40});
  expect_no_kink_or_loop(points, 0.09, 0.0, 1.5 * kPi);
}

// Two arcs of 30 m that meet at 60°: the curve between them joins curved legs.
TEST(ReferenceLineShapes, CornerOfCurvedLegs) {
  WayPoints points;
  for (int i = 10; i >= 0; --i) {
    const double angle = 0.1 * i;
    points.push_back({-30.0 * std::sin(angle), 30.0 - 30.0 * std::cos(angle)});
  }
  for (int i = 1; i <= 10; ++i) {
    const double angle = 0.1 * i;
    const Vector2d ahead(30.0 * std::sin(angle), 30.0 * std::cos(angle) - 30.0);
    const double turn = kPi / 3.0;
    points.push_back({std::cos(turn) * ahead.x() - std::sin(turn) * ahead.y(),
                      std::sin(turn) * ahead.x() + std::cos(turn) * ahead.y()});
  }
  expect_no_kink_or_loop(points, 0.45, -1.0, kPi / 3.0);
}

TEST(ReferenceLineShapes, SpikesAreRefusedWithTheirPlace) {
  try {
    ReferenceLine::through({{0, 0}, {20, 0}, {5, 0.5}, {40, 0}}, 1.75, 10.0);
    FAIL() << "a spike was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("turns back by 178° at (20.00, 0.00)"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReferenceLineShapes, SayWhereFewWayPointsLetThemSwingOut) {
  // A U-turn of 3 m by four way-points: the line through them is 3.6 m beside them.
  const ReferenceLine line = ReferenceLine::through({{0, 0}, {20, 0}, {20, 3}, {0, 3}}, 1.75, 10.0);
  ASSERT_EQ(line.notes().size(), 1u);
  EXPECT_NE(line.notes()[0].find("swings out by 3.6 m"), std::string::npos) << line.notes()[0];
  EXPECT_TRUE(
      ReferenceLine::through({{0, 0}, {20, 0}, {20, 3}, {0, 3}}, 4.5, 10.0).notes().empty());
}

TEST(ReferenceLineShapes, CornersAreRoundedForAVehicleInsideItsRoad) {
  const WayPoints right_angle{{0, 0}, {40, 0}, {40, 40}};
  const geometry::VehicleShape vehicle;
  ReferenceLineOptions options{
      .max_smoothing_m = 0.05, .corner_vehicle = vehicle, .corner_speed_mps = 10.0};
  const ReferenceLine narrow = ReferenceLine::through(right_angle, 2.5, 10.0, options);
  ASSERT_EQ(narrow.notes().size(), 1u);  // not at 10 m/s
  EXPECT_EQ(narrow.notes()[0].find("corner at (40.00, 0.00): rounded for "), 0u)
      << narrow.notes()[0];
  for (double s_m = 5.0; s_m < narrow.length_m() - 5.0; s_m += 0.05) {
    const ReferencePoint at = narrow.at(s_m);
    const geometry::Rectangle body =
        geometry::body_at({at.in_map.x(), at.in_map.y(), at.heading_rad}, vehicle);
    EXPECT_GT(geometry::distance_m(body, Vector2d(37.5, 2.5)), 0.0) << s_m << " m";
    for (const Vector2d& corner : body.corners()) {
      EXPECT_LT(corner.x(), 42.5 + 0.1);
      EXPECT_GT(corner.y(), -2.5 - 0.1);
    }
  }
  const ReferenceLine wide = ReferenceLine::through(right_angle, 12.0, 10.0, options);
  EXPECT_TRUE(wide.notes().empty());
  EXPECT_LT(shape_of_line(wide).peak_curvature_per_m, shape_of_line(narrow).peak_curvature_per_m);
}

}  // namespace
}  // namespace roadbed::planning
