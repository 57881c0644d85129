#include "roadbed/geometry/polygons/ring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/geometry/polygons/exact.h"

namespace roadbed::geometry {
namespace {

// A strip along an arc whose inner border folds where the arc is tighter than half the width.
Ring strip(double radius_m, double width_m, double angle_rad, int steps, double phase_rad) {
  Ring ring;
  const auto at = [&](double r_m, int i) {
    const double a = phase_rad + angle_rad * i / steps;
    return Eigen::Vector2d(100.0 + r_m * std::cos(a), 50.0 + r_m * std::sin(a));
  };
  for (int i = 0; i <= steps; ++i) ring.push_back(at(radius_m + 0.5 * width_m, i));
  for (int i = steps; i >= 0; --i) ring.push_back(at(radius_m - 0.5 * width_m, i));
  return ring;
}

TEST(SurelySimple, NeverCallsARingSimpleThatIsNot) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> radius_m(0.1, 60.0), width_m(0.0, 5.0), turn(0.0, 6.5);
  std::normal_distribution<double> noise_m(0.0, 0.2);
  int sure = 0, folded = 0;
  for (int i = 0; i < 3000; ++i) {
    Ring ring = strip(radius_m(random), width_m(random), turn(random), 2 + i % 30, turn(random));
    if (i % 2 == 0) {
      for (auto& point : ring) point += Eigen::Vector2d(noise_m(random), noise_m(random));
    }
    const bool simple = exact::has_simple_edges(ring);
    if (is_surely_simple(ring)) {
      EXPECT_TRUE(simple) << "ring " << i;
      ++sure;
    }
    folded += simple ? 0 : 1;
  }
  EXPECT_GT(sure, 500);
  EXPECT_GT(folded, 300);
}

TEST(SurelySimple, KnowsOrdinaryLanes) {
  EXPECT_TRUE(is_surely_simple(strip(40.0, 3.5, 1.5, 60, 0.3)));
  EXPECT_TRUE(is_surely_simple({{0, 0}, {80, 0}, {80, 3.5}, {0, 3.5}}));
  EXPECT_TRUE(is_surely_simple({{0, 0}, {1, 0}, {0, 1}}));
}

TEST(SurelySimple, SaysNothingOfRingsNearlyTouchingThemselves) {
  EXPECT_FALSE(is_surely_simple({{0, 0}, {50, 3}, {100, 0}, {50, 2.999999}}));
}

}  // namespace
}  // namespace roadbed::geometry
