#include "roadbed/tools/report/occupied_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tools {
namespace {

Eigen::AlignedBox2d everywhere() {
  return {Eigen::Vector2d(-1e5, -1e5), Eigen::Vector2d(1e5, 1e5)};
}

TEST(OccupiedPoints, AreTheMiddlesOfAllOccupiedCells) {
  const auto occupancy = map::OccupancyMap::load(tests::data_folder() / "town.bt");
  const auto points = occupied_points(occupancy, everywhere(), {100.0, 50.0});
  std::set<std::array<float, 3>> expected, found;
  for (const map::OccupancyCell& cell : occupancy.cells()) {
    if (cell.state != map::CellState::occupied) continue;
    const Eigen::Vector3f place =
        (cell.centre_in_source - Eigen::Vector3d(100.0, 50.0, 0.0)).cast<float>();
    expected.insert({place.x(), place.y(), place.z()});
  }
  for (const SizedPoint& point : points) {
    found.insert({point.place.x(), point.place.y(), point.place.z()});
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(points.size(), expected.size());
}

TEST(OccupiedPoints, CoarserOnesCoverAllCellsWithFewEnough) {
  const auto occupancy = map::OccupancyMap::load(tests::data_folder() / "town.bt");
  const auto all = occupied_points(occupancy, everywhere(), {0.0, 0.0});
  for (const std::size_t most : {all.size() - 1, all.size() / 4, std::size_t{50}}) {
    const auto coarse = occupied_points(occupancy, everywhere(), {0.0, 0.0}, most);
    EXPECT_LE(coarse.size(), most);
    for (const SizedPoint& point : all) {
      const bool is_covered = std::ranges::any_of(coarse, [&](const SizedPoint& wide) {
        const float reach_m = 0.5F * (wide.size_m - point.size_m) + 1e-3F;
        return ((wide.place - point.place).cwiseAbs().array() <= reach_m).all();
      });
      ASSERT_TRUE(is_covered) << point.place.transpose();
    }
  }
}

}  // namespace
}  // namespace roadbed::tools
