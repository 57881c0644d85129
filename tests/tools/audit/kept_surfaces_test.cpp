#include "roadbed/tools/audit/kept_surfaces.h"

#include <gtest/gtest.h>

namespace roadbed::tools {
namespace {

std::vector<geometry::Polygon> square(double side_m) {
  return {{{{0.0, 0.0}, {side_m, 0.0}, {side_m, side_m}, {0.0, side_m}}, {}}};
}

TEST(KeptSurfaces, AreMadeOnceOfThePolygonsAndTheSeamAndAreTheirUnion) {
  KeptSurfaces kept;
  const auto first = kept.of(square(10.0), 0.01);
  EXPECT_EQ(kept.of(square(10.0), 0.01), first);
  EXPECT_NE(kept.of(square(10.0), 0.02), first);
  const auto other = kept.of(square(11.0), 0.01);
  EXPECT_FALSE(first->edges.contains({10.5, 1.0}));
  EXPECT_TRUE(other->edges.contains({10.5, 1.0}));
  EXPECT_EQ(kept.of(square(10.0), 0.01), first);
}

TEST(KeptSurfaces, AreThoseThatWereUsedLast) {
  KeptSurfaces kept;
  const auto first = kept.of(square(1.0), 0.01), second = kept.of(square(2.0), 0.01);
  for (std::size_t i = 2; i < KeptSurfaces::kMost; ++i) kept.of(square(1.0 + double(i)), 0.01);
  EXPECT_EQ(kept.of(square(1.0), 0.01), first);
  kept.of(square(100.0), 0.01);  // in place of the second, which was used longest ago
  EXPECT_EQ(kept.of(square(1.0), 0.01), first);
  EXPECT_NE(kept.of(square(2.0), 0.01), second);
}

}  // namespace
}  // namespace roadbed::tools
