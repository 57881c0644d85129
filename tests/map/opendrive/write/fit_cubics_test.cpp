#include "roadbed/map/opendrive/write/fit_cubics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::map::opendrive {
namespace {

std::vector<Sample> random_samples(std::mt19937& random) {
  std::uniform_real_distribution<double> step(0.05, 3.0), turn(-0.15, 0.15);
  std::vector<Sample> samples{{10.0, 3.5}};
  double slope = 0.0;
  for (int i = 0; i < 200; ++i) {
    slope = 0.9 * slope + turn(random);
    const double step_m = step(random);
    samples.push_back({samples.back().s_m + step_m, samples.back().value + slope * step_m});
  }
  return samples;
}

TEST(FitCubics, NoRecordLeavesTheLineThroughTheSamples) {
  std::mt19937 random(20261125);
  for (int run = 0; run < 50; ++run) {
    const auto samples = random_samples(random);
    const geometry::PiecewiseCubic fitted(fit_cubics(samples, 0.01, -1e300));
    EXPECT_LT(fitted.records().size(), samples.size());
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const Sample &a = samples[i - 1], &b = samples[i];
      for (double share = 0.0; share <= 1.0; share += 0.05) {
        const double value = a.value + share * (b.value - a.value);
        // Checked at quarters of each stretch; between them a cubic bends little.
        EXPECT_NEAR(fitted.at(a.s_m + share * (b.s_m - a.s_m)).value, value, 0.013);
      }
    }
  }
}

TEST(FitCubics, RecordsMeetEachOther) {
  std::mt19937 random(20261126);
  const auto samples = random_samples(random);
  const auto records = fit_cubics(samples, 0.01, -1e300);
  EXPECT_EQ(records.front().a, samples.front().value);
  for (std::size_t i = 1; i < records.size(); ++i) {
    EXPECT_NEAR(geometry::cubic_at(records[i - 1], records[i].s_m).value, records[i].a, 1e-9);
  }
  EXPECT_NEAR(geometry::cubic_at(records.back(), samples.back().s_m).value, samples.back().value,
              1e-9);
}

TEST(FitCubics, ACubicIsOneRecord) {
  std::vector<Sample> samples;
  const geometry::CubicRecord cubic{0.0, 3.0, 0.02, -0.004, 0.00006};
  for (double s = 0.0; s <= 40.0; s += 0.1) {
    samples.push_back({s, geometry::cubic_at(cubic, s).value});
  }
  const auto records = fit_cubics(samples, 0.002, -1e300);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_NEAR(records[0].c, cubic.c, 1e-5);
}

TEST(FitCubics, WhatHasACornerKeepsIt) {
  const std::vector<Sample> samples{{0, 3}, {10, 3}, {11, 0}, {20, 0}};
  const auto records = fit_cubics(samples, 1e-4, -1e-9);
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[1].b, -3.0);
}

TEST(FitCubics, NoWidthIsNegative) {
  std::vector<Sample> samples;
  for (double s = 0.0; s <= 30.0; s += 0.5) samples.push_back({s, std::max(0.0, 0.3 * (s - 12.2))});
  const geometry::PiecewiseCubic fitted(fit_cubics(samples, 0.02, -1e-9));
  for (double s = 0.0; s <= 30.0; s += 0.05) EXPECT_GE(fitted.at(s).value, -1e-3) << s;
}

}  // namespace
}  // namespace roadbed::map::opendrive
