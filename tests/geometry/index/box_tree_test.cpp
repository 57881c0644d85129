#include "roadbed/geometry/index/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "roadbed/geometry/index/hilbert.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

std::vector<Box> random_boxes(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> place(-100.0, 100.0), size(0.0, 15.0);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d low(place(random), place(random));
    boxes.emplace_back(low, low + Vector2d(size(random), size(random)));
  }
  return boxes;
}

TEST(BoxTree, FindsJustTheBoxesThatMeetABox) {
  std::mt19937 random(20261121);
  for (const std::size_t count : {0U, 1U, 8U, 9U, 64U, 65U, 700U}) {
    const std::vector<Box> boxes = random_boxes(random, count);
    const BoxTree tree(boxes);
    for (const Box& asked : random_boxes(random, 50)) {
      std::vector<std::size_t> expected, found;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].intersects(asked)) expected.push_back(i);
      }
      tree.visit(asked, [&](std::size_t index) { found.push_back(index); });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected) << count << " boxes";
    }
  }
}

TEST(BoxTree, FindsTheNearestBox) {
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> place(-150.0, 150.0);
  const std::vector<Box> boxes = random_boxes(random, 500);
  const BoxTree tree(boxes);
  for (int i = 0; i < 200; ++i) {
    const Vector2d point(place(random), place(random));
    const auto distance_m = [&](std::size_t index) { return boxes[index].exteriorDistance(point); };
    double least_m = 1e300;
    for (std::size_t k = 0; k < boxes.size(); ++k) least_m = std::min(least_m, distance_m(k));
    const std::size_t found = tree.nearest(point, 1e300, distance_m);
    ASSERT_LT(found, boxes.size());
    EXPECT_EQ(distance_m(found), least_m);
    EXPECT_EQ(tree.nearest(point, least_m, distance_m), boxes.size());  // none is nearer still
  }
}

TEST(Hilbert, NeighboursAlongTheCurveAreNeighboursInTheGrid) {
  std::vector<std::pair<int, int>> cell_at(64 * 64);
  const std::uint32_t first = hilbert_index(0, 0);
  EXPECT_EQ(first, 0U);
  for (int x = 0; x < 64; ++x) {
    for (int y = 0; y < 64; ++y) {
      const auto index =
          hilbert_index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      ASSERT_LT(index, cell_at.size());
      cell_at[index] = {x, y};
    }
  }
  for (std::size_t i = 1; i < cell_at.size(); ++i) {
    EXPECT_EQ(std::abs(cell_at[i].first - cell_at[i - 1].first) +
                  std::abs(cell_at[i].second - cell_at[i - 1].second),
              1);
  }
}

}  // namespace
}  // namespace roadbed::geometry
