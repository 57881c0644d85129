#include "roadbed/geometry/curves/piecewise_cubic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::geometry {
namespace {

TEST(PiecewiseCubic, TheLastRecordAtOrBeforeSHolds) {
  const PiecewiseCubic cubic({{0.0, 1.0, 0, 0, 0}, {10.0, 2.0, 0.5, 0, 0}});
  EXPECT_EQ(cubic.at(9.999).value, 1.0);
  EXPECT_EQ(cubic.at(10.0).value, 2.0);
  EXPECT_EQ(cubic.at(10.0, 9.0).value, 1.0);
  EXPECT_EQ(cubic.at(12.0).value, 3.0);
  EXPECT_EQ(PiecewiseCubic().at(3.0).value, 0.0);
}

TEST(PiecewiseCubic, DerivativesMatchDifferences) {
  const PiecewiseCubic cubic({{2.0, 1.0, -0.3, 0.02, -0.001}});
  const double h = 1e-4;
  for (double s = 3.0; s < 30.0; s += 2.7) {
    const double d1 = (cubic.at(s + h).value - cubic.at(s - h).value) / (2 * h);
    const double d2 =
        (cubic.at(s + h).value - 2 * cubic.at(s).value + cubic.at(s - h).value) / (h * h);
    EXPECT_NEAR(cubic.at(s).d1, d1, 1e-7);
    EXPECT_NEAR(cubic.at(s).d2, d2, 1e-5);
  }
}

TEST(PiecewiseCubic, BoundsHoldEverywhereAndAreNearOverShortStretches) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const PiecewiseCubic cubic(
        {{0.0, unit(random), unit(random), 0.1 * unit(random), 0.01 * unit(random)}});
    const double from = 5.0 + 4.0 * unit(random), to = from + 1.0;
    const CubicValue bounds = cubic.bounds(from, to);
    double highest = 0.0;
    for (double s = from; s <= to; s += 0.01) {
      const CubicValue value = cubic.at(s);
      highest = std::max(highest, std::abs(value.d2));
      EXPECT_LE(std::abs(value.value), bounds.value + 1e-12);
      EXPECT_LE(std::abs(value.d1), bounds.d1 + 1e-12);
      EXPECT_LE(std::abs(value.d2), bounds.d2 + 1e-12);
    }
    EXPECT_LE(bounds.d2, highest + 0.061);  // 6·|d|·half a metre, twice
  }
}

TEST(PiecewiseCubic, RefusesRecordsOutOfOrder) {
  EXPECT_THROW(PiecewiseCubic({{1.0, 0, 0, 0, 0}, {0.0, 0, 0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(PiecewiseCubic({{0.0, std::nan(""), 0, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
