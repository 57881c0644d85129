#include "roadbed/map/elements/lane_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::map {
namespace {

using Line = std::vector<Eigen::Vector3d>;

Line random_line(std::mt19937& random, double y_m) {
  std::uniform_real_distribution<double> step(0.0, 3.0), side(-0.4, 0.4);
  Line line{{0.0, y_m, 0.0}};
  const int points = 1 + static_cast<int>(random() % 20);
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3d last = line.back();
    line.emplace_back(last.x() + step(random), y_m + side(random), last.z() + side(random));
  }
  return line;
}

/// The point at a fraction of the line's length in plan, searched from its start.
Eigen::Vector3d at_fraction(const Line& line, double fraction) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i)
    length_m += (line[i] - line[i - 1]).head<2>().norm();
  double left_m = fraction * length_m;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step_m = (line[i] - line[i - 1]).head<2>().norm();
    if (left_m <= step_m && step_m > 0.0) {
      return line[i - 1] + left_m / step_m * (line[i] - line[i - 1]);
    }
    left_m -= step_m;
  }
  return line.back();
}

TEST(LaneLines, CentrelineIsHalfwayBetweenPlacesAtTheSameFraction) {
  std::mt19937 random(20261125);
  for (int i = 0; i < 300; ++i) {
    const Line left = random_line(random, 3.0), right = random_line(random, 0.0);
    Lane lane;
    set_borders(left, right, lane);
    EXPECT_EQ(lane.left.in_map.points().size(), left.size());
    EXPECT_EQ(lane.right.in_map.points().size(), right.size());
    // Between vertices of the centreline both borders are straight, so fractions grow evenly.
    for (double fraction = 0.0; fraction <= 1.0; fraction += 0.05) {
      const Eigen::Vector3d expected =
          0.5 * (at_fraction(left, fraction) + at_fraction(right, fraction));
      const double off_m = lane.centre.in_map.project(expected.head<2>()).d_m;
      EXPECT_NEAR(off_m, 0.0, 1e-9);
    }
  }
}

TEST(LaneLines, StationsOfBordersAreThoseOfTheCentreline) {
  Lane lane;
  set_borders({{0, 4, 0}, {3, 4, 0}, {10, 4, 2}}, {{0, 0, 0}, {10, 0, 1}}, lane);
  EXPECT_EQ(lane.left.station_m, (std::vector<double>{0.0, 3.0, 10.0}));
  EXPECT_EQ(lane.right.station_m, (std::vector<double>{0.0, 10.0}));
  EXPECT_EQ(lane.centre.station_m, lane.left.station_m);
  EXPECT_DOUBLE_EQ(lane.centre.z_m.back(), 1.5);
  EXPECT_FALSE(has_swapped_borders(lane));
}

TEST(LaneLines, OriginIsNearAPointThatIsFarOut) {
  EXPECT_EQ(origin_near({-20'000.0, 20'000.0}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(origin_near({20'000.1, -1'499.0}), Eigen::Vector2d(20'000, -1'000));
}

}  // namespace
}  // namespace roadbed::map
