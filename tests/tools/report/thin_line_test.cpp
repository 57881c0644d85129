#include "roadbed/tools/report/thin_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::tools {
namespace {

LineInSource wavy_line(std::mt19937& random) {
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  LineInSource line;
  for (int i = 0; i < 300; ++i) {
    line.emplace_back(0.1 * i, std::sin(0.05 * i) + noise(random));
  }
  return line;
}

TEST(ThinLine, DropsNoPointFartherAwayThanTheTolerance) {
  std::mt19937 random(20261121);
  for (int round = 0; round < 50; ++round) {
    const LineInSource line = wavy_line(random);
    const LineInSource thinned = thin_line(line, 0.05);
    const geometry::Polyline shown(thinned);
    for (const auto& point : line) {
      const geometry::LinePosition foot = shown.project(point);
      EXPECT_LE((shown.at(foot.s_m) - point).norm(), 0.05 + 1e-12);
    }
    EXPECT_LT(thinned.size(), line.size() / 3);
    EXPECT_EQ(thinned.front(), line.front());
    EXPECT_EQ(thinned.back(), line.back());
  }
}

TEST(ThinLine, LeavesTwoPointsOfAStraightLine) {
  EXPECT_EQ(thin_line({{0, 0}, {1, 1}, {2, 2}, {5, 5}}, 1e-9).size(), 2U);
}

TEST(ThinLine, KeepsALineThatComesBackToItsStart) {
  EXPECT_EQ(thin_line({{0, 0}, {3, 0}, {0, 0}}, 0.1).size(), 3U);
}

TEST(ThinLine, LeavesShortLinesAsTheyAre) {
  EXPECT_TRUE(thin_line({}, 1.0).empty());
  EXPECT_EQ(thin_line({{1, 2}}, 1.0).size(), 1U);
}

}  // namespace
}  // namespace roadbed::tools
