#include "roadbed/map/occupancy/clearance/grid_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace roadbed::map {
namespace {

void no_slabs(const CellRange&, const UseSlab&) {}

TEST(GridTiles, KeepsNoMoreTilesAliveThanAllowedAndTheLastUsedOnes) {
  std::vector<std::weak_ptr<const PlanGrid>> made;
  const GridTiles tiles(10, 3, [&](const CellRange& tile) {
    auto grid =
        std::make_shared<const PlanGrid>(no_slabs, GridExtent{tile, tile.grown(1), false}, 1, 0.1);
    made.push_back(grid);
    return grid;
  });
  const auto alive = [&] {
    return std::ranges::count_if(made, [](const auto& grid) { return !grid.expired(); });
  };
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<std::int64_t>(random() % 100) - 50;
    const auto y = static_cast<std::int64_t>(random() % 100) - 50;
    const auto grid = tiles.at(x, y);
    ASSERT_LE(alive(), 3);
    const std::size_t before = made.size();
    ASSERT_EQ(tiles.at(x, y), grid);
    ASSERT_EQ(made.size(), before);
  }
}

TEST(GridTiles, ATileHoldsTheCellsThatAskForIt) {
  CellRange asked;
  const GridTiles tiles(7, 1, [&](const CellRange& tile) {
    asked = tile;
    return std::make_shared<const PlanGrid>(no_slabs, GridExtent{tile, tile, false}, 1, 0.1);
  });
  for (std::int64_t x = -20; x < 20; ++x) {
    tiles.at(x, -x);
    EXPECT_TRUE(asked.holds(x, -x));
    EXPECT_EQ(asked.count(), 49u);
  }
}

}  // namespace
}  // namespace roadbed::map
