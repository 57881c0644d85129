#include "roadbed/map/opendrive/write/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace roadbed::map::opendrive {
namespace {

TEST(NumberText, IsWithinItsTolerance) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> exponent(-9.0, 6.0);
  for (int run = 0; run < 10000; ++run) {
    const double value = (run % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent(random));
    for (const double tolerance : {0.5, 1e-3, 5e-7, 2e-10}) {
      const std::string text = number_within(value, tolerance);
      const double rounding = 4e-16 * std::abs(value);
      EXPECT_NEAR(std::stod(text), value, tolerance + rounding) << text;
    }
  }
}

TEST(NumberText, SaysNoMoreThanItMust) {
  EXPECT_EQ(number_within(0.0, 1e-6), "0");
  EXPECT_EQ(number_within(-1e-9, 1e-6), "0");
  EXPECT_EQ(number_within(100.0, 1e-6), "100");
  EXPECT_EQ(number_within(-2.5, 1e-6), "-2.5");
  EXPECT_EQ(number_within(1.0 / 3.0, 5e-4), "0.333");
  EXPECT_EQ(number_within(1234.5, 0.5), "1234");
  EXPECT_EQ(short_number(457919.60994004), "457919.60994");
}

}  // namespace
}  // namespace roadbed::map::opendrive
