#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/way_point_path.h"

namespace roadbed::planning {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Two straight legs with a right angle between them.
const Points kRightAngle{{0, 0}, {20, 0}, {40, 0}, {40, 20}, {40, 40}};

double largest(const ReferenceLine& line, double ReferencePoint::*field) {
  double most = 0.0;
  for (double s = 0.0; s <= line.length_m(); s += 0.05) {
    most = std::max(most, std::abs(line.at(s).*field));
  }
  return most;
}

TEST(ReferenceLineThrough, RoundsARightAngleAsGentlyAsTheBezierOf14Metres) {
  const ReferenceLine line = ReferenceLine::through(kRightAngle, 1.75, 10.0);
  EXPECT_LE(largest(line, &ReferencePoint::curvature_per_m), 0.12);
  EXPECT_LE(largest(line, &ReferencePoint::curvature_d1_per_m2), 0.02);
  EXPECT_LE(line.largest_move_m(), 0.05);
  EXPECT_NEAR(line.at(line.length_m()).heading_rad - line.at(0.0).heading_rad, std::acos(0.0),
              0.01);
}

TEST(ReferenceLineThrough, PassesNearWayPointsOfABendingRoad) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> turn(-0.25, 0.25), step(6.0, 15.0);
  Points points{{100.0, 50.0}};
  double heading = 1.0;
  for (int i = 0; i < 40; ++i) {
    heading += turn(random);
    points.push_back(points.back() +
                     step(random) * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  const ReferenceLine line = ReferenceLine::through(points, 1.75, 10.0);
  for (const auto& point : points) EXPECT_LE(std::abs(line.project(point).d_m), 0.3);
  EXPECT_LE(line.largest_move_m(), 0.3);
  EXPECT_LE(largest(line, &ReferencePoint::curvature_per_m), 0.2);
}

TEST(ReferenceLineThrough, DerivativesAreThoseOfItsPositions) {
  const ReferenceLine line = ReferenceLine::through(kRightAngle, 1.75, 10.0);
  const double h = 1e-3;
  for (double s = 1.0; s < line.length_m() - 1.0; s += 0.173) {
    const ReferencePoint before = line.at(s - h), here = line.at(s), after = line.at(s + h);
    const Eigen::Vector2d velocity = (after.in_map - before.in_map) / (2.0 * h);
    EXPECT_NEAR(velocity.norm(), 1.0, 1e-6);
    const Eigen::Vector2d bend = (after.in_map - 2.0 * here.in_map + before.in_map) / (h * h);
    EXPECT_NEAR(here.curvature_per_m, velocity.x() * bend.y() - velocity.y() * bend.x(), 1e-6);
    EXPECT_NEAR(here.curvature_d1_per_m2,
                (after.curvature_per_m - before.curvature_per_m) / (2.0 * h), 1e-6);
    EXPECT_NEAR(here.curvature_d2_per_m3,
                (after.curvature_d1_per_m2 - before.curvature_d1_per_m2) / (2.0 * h), 1e-6);
    EXPECT_NEAR(here.curvature_d3_per_m4,
                (after.curvature_d2_per_m3 - before.curvature_d2_per_m3) / (2.0 * h), 1e-5);
    EXPECT_NEAR(here.curvature_d4_per_m5,
                (after.curvature_d3_per_m4 - before.curvature_d3_per_m4) / (2.0 * h), 1e-3);
  }
}

TEST(ReferenceLineThrough, ChainsOfCornersShareTheirLegsWithoutLoops) {
  Points points{{0, 0}};
  for (int i = 0; i < 6; ++i) {
    points.push_back(points.back() + Eigen::Vector2d(16, 0));
    points.push_back(points.back() + Eigen::Vector2d(0, i % 2 == 0 ? 16 : -16));
  }
  const ReferenceLine line = ReferenceLine::through(points, 1.75, 10.0);
  EXPECT_LE(largest(line, &ReferencePoint::curvature_per_m), 0.25);
  for (double s = 0.0; s < line.length_m(); s += 0.1) {
    EXPECT_LE(std::abs(line.at(s).heading_rad), 2.0) << "turned round at " << s << " m";
  }
}

TEST(ReferenceLineThrough, HasTheGivenRoomAndSpeedEverywhere) {
  const ReferenceLine line = ReferenceLine::through({{0, 0}, {50, 0}}, 1.6, 12.0);
  for (const double s : {-10.0, 0.0, 25.0, 70.0}) {
    EXPECT_EQ(line.corridor_at(s).left_m, 1.6);
    EXPECT_EQ(line.corridor_at(s).right_m, 1.6);
    EXPECT_EQ(line.corridor_at(s).speed_limit_mps, 12.0);
  }
  EXPECT_NEAR(line.goal_s_m(), 50.0, 1e-6);
  EXPECT_NEAR(line.project({30.0, -1.0}, 25.0).d_m, -1.0, 1e-6);
}

TEST(ReferenceLineThrough, PathGoesThroughTheWayPointsThatItNames) {
  const WayPointPath path = path_through(kRightAngle, 0.25);
  ASSERT_EQ(path.way_points.size(), 4U);  // all but the corner
  for (const auto& way_point : path.way_points) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const auto& point : path.points)
      nearest_m = std::min(nearest_m, (point - way_point).norm());
    EXPECT_LE(nearest_m, 0.13);
  }
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    EXPECT_LE((path.points[i] - path.points[i - 1]).norm(), 0.2501);
  }
}

TEST(ReferenceLineThrough, RefusesASinglePlaceAndWayPointsThatAreNotFinite) {
  EXPECT_THROW(ReferenceLine::through({{1, 1}, {1, 1}}, 1.0, 10.0), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ReferenceLine::through({{1, 1}, {nan, 1}}, 1.0, 10.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
