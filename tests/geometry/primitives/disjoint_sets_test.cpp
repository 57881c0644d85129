#include "roadbed/geometry/primitives/disjoint_sets.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace roadbed::geometry {
namespace {

TEST(DisjointSets, AreThoseOfRelabellingAllWithTheLeastNumber) {
  std::mt19937 draw(7);
  for (int round = 0; round < 50; ++round) {
    const std::size_t count = 1 + draw() % 40;
    DisjointSets sets(count);
    std::vector<std::size_t> labels(count);
    std::iota(labels.begin(), labels.end(), std::size_t{0});
    for (int joined = 0; joined < 30; ++joined) {
      const std::size_t a = draw() % count, b = draw() % count;
      sets.join(a, b);
      const std::size_t one = labels[a], other = labels[b];
      for (std::size_t& label : labels) {
        if (label == one || label == other) label = std::min(one, other);
      }
    }
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(sets.of(i), labels[i]);
  }
}

}  // namespace
}  // namespace roadbed::geometry
