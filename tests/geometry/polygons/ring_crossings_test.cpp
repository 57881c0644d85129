#include "roadbed/geometry/polygons/ring_crossings.h"

#include <gtest/gtest.h>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

// As many strips upwards as to the right, each across all of the others.
std::vector<Ring> fabric(int strips) {
  const double length = 2.0 * strips;
  std::vector<Ring> rings;
  for (int i = 0; i < strips; ++i) {
    const double at = 2.0 * i + 0.5;
    rings.push_back(box_ring({0.0, at}, {length, at + 1.0}));
    rings.push_back(box_ring({at, 0.0}, {at + 1.0, length}));
  }
  return rings;
}

TEST(RingCrossings, AreFewOfRingsInARowAndOfRingsThatShareTheirEdges) {
  std::vector<Ring> row, grid;
  for (int i = 0; i < 3000; ++i) {
    row.push_back(box_ring({i, 0.0}, {i + 1.5, 1.0}));
    grid.push_back(box_ring({i % 50, i / 50}, {i % 50 + 1, i / 50 + 1}));
  }
  EXPECT_TRUE(have_few_crossings(row));
  EXPECT_TRUE(have_few_crossings(grid));
  EXPECT_TRUE(have_few_crossings({}));
}

// n² places where two strips cross, four corners each.
TEST(RingCrossings, AreFewUpToFiftyThousandAndSixteenPerEdge) {
  EXPECT_TRUE(have_few_crossings(fabric(100)));   // 40,000
  EXPECT_FALSE(have_few_crossings(fabric(140)));  // 78,400; 67,920 are allowed
}

}  // namespace
}  // namespace roadbed::geometry
