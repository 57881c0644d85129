#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tools/report/surroundings.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>
#include <vector>

namespace roadbed::tools {
namespace {

constexpr double kCell_m = 0.1;
const Eigen::Vector2d kOrigin(358000.05, 5702000.05);

map::Box2 cell_box(int x, int y) {
  const Eigen::Vector2d corner = kOrigin + kCell_m * Eigen::Vector2d(x, y);
  return {corner, corner + Eigen::Vector2d(kCell_m, kCell_m)};
}

bool covers(const std::vector<map::Box2>& boxes, const Eigen::Vector2d& point) {
  for (const map::Box2& box : boxes) {
    const bool inside = (point.array() > box.min_in_source.array()).all() &&
                        (point.array() < box.max_in_source.array()).all();
    if (inside) return true;
  }
  return false;
}

TEST(JoinedBoxes, CoverWhatTheCellsCoverAndNothingElse) {
  std::mt19937 random(20261121);
  constexpr int kSide = 12;
  for (int round = 0; round < 100; ++round) {
    std::set<std::pair<int, int>> cells;
    std::vector<map::Box2> boxes;
    for (int i = 0; i < 90; ++i) {
      const int x = static_cast<int>(random() % kSide), y = static_cast<int>(random() % kSide);
      cells.insert({x, y});
      boxes.push_back(cell_box(x, y));  // some twice
    }
    const auto result = joined(boxes);
    EXPECT_LT(result.size(), cells.size());
    for (int x = -1; x <= kSide; ++x) {
      for (int y = -1; y <= kSide; ++y) {
        const Eigen::Vector2d middle = kOrigin + kCell_m * Eigen::Vector2d(x + 0.5, y + 0.5);
        EXPECT_EQ(covers(result, middle), cells.contains({x, y}));
      }
    }
  }
}

TEST(JoinedBoxes, MakeOneOfAWholeBlock) {
  std::vector<map::Box2> boxes;
  for (int x = 0; x < 7; ++x) {
    for (int y = 0; y < 5; ++y) boxes.push_back(cell_box(x, y));
  }
  const auto result = joined(boxes);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_NEAR((result[0].min_in_source - kOrigin).norm(), 0.0, 1e-9);
  EXPECT_NEAR((result[0].max_in_source - kOrigin - Eigen::Vector2d(0.7, 0.5)).norm(), 0.0, 1e-9);
}

TEST(OccupiedIn, LeavesOutWhatIsAboveBelowBesideOrOnlyAPassage) {
  map::PointCloud cloud;
  cloud.points = {{1.05F, 1.05F, 0.65F},    // in the band
                  {3.05F, 1.05F, 0.05F},    // on the ground
                  {5.05F, 1.05F, 2.55F},    // a branch
                  {90.05F, 1.05F, 0.65F}};  // far away
  cloud.sensor_in_source = Eigen::Vector3d(0, 0, 1);
  const std::vector<map::PointCloud> clouds{cloud};
  const auto occupancy = map::OccupancyMap::build(clouds, {.resolution_m = 0.1});
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-10, -10), Eigen::Vector2d(10, 10));
  const auto occupied = occupied_in(occupancy, {.from_m = 0.2, .to_m = 1.5}, box);
  ASSERT_EQ(occupied.size(), 1U);
  EXPECT_TRUE(covers(occupied, {1.05, 1.05}));
}

}  // namespace
}  // namespace roadbed::tools
