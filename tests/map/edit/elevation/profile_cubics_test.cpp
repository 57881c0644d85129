#include "roadbed/map/edit/elevation/profile_cubics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbed::map {
namespace {

double wave(double s_m) { return 2.0 * std::sin(s_m / 40.0) + 0.03 * s_m; }

TEST(ProfileCubics, PassSamplesWithinTheToleranceWithoutAKink) {
  std::vector<double> s_m, z_m;
  for (double s = 0.0; s < 301.0; s += 2.0) s_m.push_back(s), z_m.push_back(wave(s));
  const auto records = cubics_through(s_m, z_m, 0.002);
  EXPECT_LT(records.size(), 20u);
  const geometry::PiecewiseCubic profile(records);
  for (double s = 0.0; s <= 300.0; s += 0.1) EXPECT_NEAR(profile.at(s).value, wave(s), 0.0025);
  for (std::size_t i = 1; i < records.size(); ++i) {
    const double s = records[i].s_m;
    EXPECT_NEAR(geometry::cubic_at(records[i - 1], s).value, records[i].a, 1e-9);
    EXPECT_NEAR(geometry::cubic_at(records[i - 1], s).d1, records[i].b, 1e-9);
  }
}

TEST(ProfileCubics, OfALineAreOne) {
  const std::vector<double> s_m{0, 2, 4, 6, 7.5}, z_m{1.0, 1.1, 1.2, 1.3, 1.375};
  const auto records = cubics_through(s_m, z_m, 1e-9);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_NEAR(records[0].b, 0.05, 1e-12);
  EXPECT_NEAR(records[0].c, 0.0, 1e-12);
}

TEST(ProfileCubics, OfOneSampleAreLevel) {
  const auto records = cubics_through(std::vector<double>{0.0}, std::vector<double>{4.0}, 0.01);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].a, 4.0);
  EXPECT_EQ(records[0].b, 0.0);
}

}  // namespace
}  // namespace roadbed::map
