#include "roadbed/tools/audit/drive_groups.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>
#include <utility>

namespace roadbed::tools {
namespace {

constexpr double kCell_m = 0.2;

// A drive of 100 m by 20 m that begins at a place, with a horizon of 50 m: 200 m by 120 m, 600,000
// cells.
DriveExtent drive_at(std::size_t number, double x_m, double y_m, double level_m = 0.0) {
  return {number,
          {.level_m = level_m},
          {.around = {{x_m, y_m}, {x_m + 100.0, y_m + 20.0}}, .horizon_m = 50.0}};
}

std::vector<std::vector<std::size_t>> numbers_of(const std::vector<DriveGroup>& groups) {
  std::vector<std::vector<std::size_t>> numbers;
  for (const DriveGroup& group : groups) numbers.push_back(group.drives);
  return numbers;
}

using Numbers = std::vector<std::vector<std::size_t>>;

TEST(DriveGroups, PutTogetherWhatTakesNoMoreCellsTogether) {
  // With 200 m between their starts, 400 m by 120 m is what both take by themselves.
  const auto groups = drive_groups(
      {drive_at(4, 0.0, 0.0), drive_at(7, 200.0, 0.0), drive_at(9, 401.0, 0.0)}, kCell_m);
  EXPECT_EQ(numbers_of(groups), (Numbers{{4, 7}, {9}}));
  EXPECT_EQ(groups[0].region.around.min_in_source, Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(groups[0].region.around.max_in_source, Eigen::Vector2d(300.0, 20.0));
}

TEST(DriveGroups, KeepLevelsAndGroundsThatAreNotLevelApart) {
  std::vector<DriveExtent> drives;
  for (std::size_t i = 0; i < 4; ++i)
    drives.push_back(drive_at(i, 0.0, 0.0, i % 2 == 0 ? 0.0 : 0.5));
  EXPECT_EQ(numbers_of(drive_groups(drives, kCell_m)), (Numbers{{0, 2}, {1, 3}}));
  drives[2].ground.margin_m = 0.1;
  EXPECT_EQ(numbers_of(drive_groups(drives, kCell_m)), (Numbers{{0}, {1, 3}, {2}}));
  for (DriveExtent& drive : drives) {
    drive.ground = {.surface =
                        std::make_shared<const map::Ground>(std::vector<map::GroundPlace>(1))};
  }
  EXPECT_EQ(drive_groups(drives, kCell_m).size(), 4u);
}

TEST(DriveGroups, TakeNoMoreCellsThanARegionMay) {
  std::vector<DriveExtent> drives{drive_at(0, 0.0, 0.0), drive_at(1, 1.0, 0.0)};
  EXPECT_EQ(drive_groups(drives, kCell_m).size(), 1u);
  for (DriveExtent& drive : drives) drive.region.most_cells = 600'000;  // 201 m by 120 m are more
  EXPECT_EQ(drive_groups(drives, kCell_m).size(), 2u);
}

TEST(DriveGroups, HoldEachDriveOnceAndTakeNoMoreCellsInAllThanEachByItself) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> place(0.0, 2000.0);
  std::vector<DriveExtent> drives;
  for (std::size_t i = 0; i < 500; ++i) drives.push_back(drive_at(i, place(random), place(random)));
  std::set<std::size_t> seen;
  double cells = 0.0;
  const std::vector<DriveGroup> groups = drive_groups(drives, kCell_m);
  for (const DriveGroup& group : groups) {
    const map::Box2& box = group.region.around;
    const Eigen::Array2d side_m = (box.max_in_source - box.min_in_source).array() + 100.0;
    cells += side_m.prod() / (kCell_m * kCell_m);
    EXPECT_LE(side_m.prod() / (kCell_m * kCell_m), 20e6);
    for (const std::size_t number : group.drives) {
      EXPECT_TRUE(seen.insert(number).second);
      const map::Box2& own = drives[number].region.around;
      EXPECT_TRUE((own.min_in_source.array() >= box.min_in_source.array()).all() &&
                  (own.max_in_source.array() <= box.max_in_source.array()).all());
    }
  }
  EXPECT_EQ(seen.size(), drives.size());
  EXPECT_LE(cells, 500 * 600'000.0);
  EXPECT_LT(groups.size(), 200u);
}

}  // namespace
}  // namespace roadbed::tools
