#include "roadbed/planning/lateral/knotted_offset.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace roadbed::planning {
namespace {

LateralState knot_of(const geometry::Quintic& quintic, double s_m) {
  const auto d = quintic.at(s_m);
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

TEST(KnottedOffset, IsTheQuinticThatItsKnotsLieOn) {
  const geometry::Quintic whole({0.4, -0.1, 0.02}, {-1.2, 0.15, -0.01}, 30.0);
  const KnottedOffset offset(
      {knot_of(whole, 0.0), knot_of(whole, 7.0), knot_of(whole, 8.5), knot_of(whole, 30.0)});
  for (double s_m = 0.0; s_m < 30.0; s_m += 0.31) {
    const LateralState at = offset.at(s_m);
    EXPECT_NEAR(at.d_m, whole.at(s_m)[0], 1e-10) << s_m;
    EXPECT_NEAR(at.d_slope, whole.at(s_m)[1], 1e-10) << s_m;
    EXPECT_NEAR(at.d_curvature_per_m, whole.at(s_m)[2], 1e-10) << s_m;
  }
}

TEST(KnottedOffset, IsTheSameFromBothSidesOfAKnot) {
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> value(-1.0, 1.0), length(1.0, 9.0);
  std::vector<LateralState> knots;
  for (double s_m = 50.0; knots.size() < 12; s_m += length(random)) {
    knots.push_back({.s_m = s_m,
                     .d_m = 3.0 * value(random),
                     .d_slope = 0.3 * value(random),
                     .d_curvature_per_m = 0.05 * value(random)});
  }
  const KnottedOffset offset(knots);
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    for (const double beside_m : {-1e-9, 0.0, 1e-9}) {
      const LateralState at = offset.at(knots[i].s_m + beside_m);
      EXPECT_NEAR(at.d_m, knots[i].d_m, 1e-7);
      EXPECT_NEAR(at.d_slope, knots[i].d_slope, 1e-7);
      EXPECT_NEAR(at.d_curvature_per_m, knots[i].d_curvature_per_m, 1e-7);
    }
  }
}

TEST(KnottedOffset, StaysBeforeItsFirstKnotAndPastItsLast) {
  const KnottedOffset offset({{.s_m = 2.0, .d_m = 1.0, .d_slope = 0.2}, {.s_m = 9.0, .d_m = -3.0}});
  EXPECT_EQ(offset.at(1.0).d_m, 1.0);
  EXPECT_EQ(offset.at(1.0).d_slope, 0.0);
  EXPECT_EQ(offset.at(20.0).d_m, -3.0);
}

TEST(KnottedOffset, RefusesStationsThatDoNotAscend) {
  EXPECT_THROW(KnottedOffset({LateralState{}}), std::invalid_argument);
  EXPECT_THROW(KnottedOffset({{.s_m = 1.0}, {.s_m = 1.0}}), std::invalid_argument);
  EXPECT_THROW(KnottedOffset({{.s_m = 1.0}, {.s_m = 0.5}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
