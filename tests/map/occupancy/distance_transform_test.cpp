#include "roadbed/map/occupancy/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace roadbed::map {
namespace {

float brute_force(const std::vector<std::uint8_t>& set, std::size_t width, std::size_t i) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (set[k] == 0) continue;
    const double dx = static_cast<double>(i % width) - static_cast<double>(k % width);
    const double dy = static_cast<double>(i / width) - static_cast<double>(k / width);
    least = std::min(least, std::hypot(dx, dy));
  }
  return static_cast<float>(least);
}

TEST(DistanceTransform, EqualsBruteForceOnRandomGridsOfAnyDensityAndNeverExceedsIt) {
  std::mt19937 random(20261121);
  for (int round = 0; round < 300; ++round) {
    const std::size_t width = 1 + random() % 24, height = 1 + random() % 24;
    const std::size_t one_in = 1 + random() % 80;
    std::vector<std::uint8_t> set(width * height);
    for (auto& cell : set) cell = random() % one_in == 0;
    const std::vector<float> distance = distances_to_set(set, width, height);
    for (std::size_t i = 0; i < set.size(); ++i) {
      const float expected = brute_force(set, width, i);
      EXPECT_LE(distance[i], expected);
      if (std::isinf(expected)) {
        EXPECT_EQ(distance[i], expected);
      } else {
        EXPECT_NEAR(distance[i], expected, 1e-5);
      }
    }
  }
}

TEST(DistanceTransform, RefusesASizeThatIsNotTheGrids) {
  EXPECT_THROW(distances_to_set(std::vector<std::uint8_t>(5), 2, 2), std::invalid_argument);
  EXPECT_TRUE(distances_to_set({}, 0, 0).empty());
}

}  // namespace
}  // namespace roadbed::map
