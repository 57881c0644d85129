#include "roadbed/geometry/polygons/polygon.h"

#include <gtest/gtest.h>

#include <limits>

namespace roadbed::geometry {
namespace {

Ring square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(PolygonFault, NoneInASquareWithTwoHolesThatTouch) {
  EXPECT_FALSE(find_fault({square(0, 0, 10), {square(1, 1, 2), square(3, 3, 2)}}));
}

TEST(PolygonFault, RotationDoesNotMatter) {
  Ring outer = square(0, 0, 10);
  std::reverse(outer.begin(), outer.end());
  EXPECT_FALSE(find_fault({outer, {square(1, 1, 2)}}));
}

TEST(PolygonFault, ARingThatCrossesItselfIsNamed) {
  const Ring bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_EQ(find_fault({bow, {}})->ring, 0U);
  EXPECT_EQ(find_fault({square(-5, -5, 20), {square(8, 8, 1), bow}})->ring, 2U);
}

TEST(PolygonFault, AHoleOutsideOrAcrossTheOuterRingIsNamed) {
  for (const Ring& hole : {square(20, 0, 2), square(9, 4, 2), square(-1, -1, 12)}) {
    const auto fault = find_fault({square(0, 0, 10), {square(1, 1, 2), hole}});
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->ring, 2U);
    EXPECT_EQ(fault->what, "it lies outside the outer ring");
  }
}

TEST(PolygonFault, HolesThatOverlapAreNamed) {
  const auto fault =
      find_fault({square(0, 0, 10), {square(1, 1, 3), square(6, 6, 2), square(2, 2, 3)}});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->ring, 3U);
  EXPECT_EQ(fault->what, "it overlaps another hole");
}

TEST(PolygonFault, RingsWithoutAreaOrWithWildPointsAreNamed) {
  EXPECT_TRUE(find_fault({{{0, 0}, {1, 0}}, {}}));
  EXPECT_TRUE(find_fault({{{0, 0}, {1, 0}, {2, 0}}, {}}));
  EXPECT_TRUE(find_fault({{{0, 0}, {1, 0}, {std::numeric_limits<double>::infinity(), 1}}, {}}));
}

}  // namespace
}  // namespace roadbed::geometry
