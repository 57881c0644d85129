#include "roadbed/map/occupancy/clearance/distance_transform.h"

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

TEST(DistanceTransform, OfAWindowIsThatPartOfTheWhole) {
  std::mt19937 random(8);
  for (int round = 0; round < 300; ++round) {
    const std::size_t width = 1 + random() % 40, height = 1 + random() % 40;
    const std::size_t one_in = 1 + random() % 200;
    std::vector<std::uint8_t> set(width * height);
    for (auto& cell : set) cell = random() % one_in == 0;
    const std::vector<float> whole = distances_to_set(set, width, height);
    CellWindow window{random() % (width + 1), random() % (height + 1), 0, 0};
    window.to_x = window.from_x + random() % (width - window.from_x + 1);
    window.to_y = window.from_y + random() % (height - window.from_y + 1);
    const std::vector<float> part = distances_to_set(set, width, height, window);
    std::size_t i = 0;
    for (std::size_t y = window.from_y; y < window.to_y; ++y) {
      for (std::size_t x = window.from_x; x < window.to_x; ++x) {
        ASSERT_EQ(part[i++], whole[y * width + x]);
      }
    }
    ASSERT_EQ(i, part.size());
  }
}

TEST(DistanceTransform, RefusesASizeThatIsNotTheGrids) {
  EXPECT_THROW(distances_to_set(std::vector<std::uint8_t>(5), 2, 2), std::invalid_argument);
  EXPECT_TRUE(distances_to_set({}, 0, 0).empty());
  EXPECT_THROW(distances_to_set(std::vector<std::uint8_t>(6), 2, 3, {0, 0, 3, 3}),
               std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
