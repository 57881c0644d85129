#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/outputs/cell_boxes.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"
#include "roadbed/map/occupancy/outputs/grid_raster.h"
#include "roadbed/map/occupancy/outputs/occupancy_changes.h"
#include "roadbed/map/occupancy/outputs/occupancy_grid.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using Places = std::set<std::array<double, 3>>;

constexpr double kCell_m = 0.5;

PointCloud cloud_of(const std::vector<Eigen::Vector3d>& points) {
  std::string text;
  for (const Eigen::Vector3d& point : points) {
    text += std::to_string(point.x()) + " " + std::to_string(point.y()) + " " +
            std::to_string(point.z()) + "\n";
  }
  return parse_point_cloud(text, "a.xyz");
}

/// Hits only, or seen from a sensor.
OccupancyMap octree_of(const std::vector<Eigen::Vector3d>& points,
                       std::optional<Eigen::Vector3d> sensor = {}) {
  PointCloud cloud = cloud_of(points);
  cloud.sensor_in_source = sensor;
  return OccupancyMap::build({&cloud, 1}, {.resolution_m = kCell_m});
}

Places places_of(const std::vector<Eigen::Vector3d>& points) {
  Places places;
  for (const Eigen::Vector3d& point : points) places.insert({point.x(), point.y(), point.z()});
  return places;
}

/// A wall at x 4, with a block of 4 x 4 x 4 cells, which an octree keeps as one leaf.
std::vector<Eigen::Vector3d> block_and_post() {
  std::vector<Eigen::Vector3d> points{{-3.1, 0.9, 1.1}};
  for (double x = 4.25; x < 6.0; x += kCell_m) {
    for (double y = 2.25; y < 4.0; y += kCell_m) {
      for (double z = 0.25; z < 2.0; z += kCell_m) points.emplace_back(x, y, z);
    }
  }
  return points;
}

TEST(CellCentres, AreThoseOfTheCellsThatHavePoints) {
  Places expected;
  for (const Eigen::Vector3d& point : block_and_post()) {
    std::array<double, 3> centre{};
    for (int i = 0; i < 3; ++i) {
      centre[static_cast<std::size_t>(i)] = (std::floor(point[i] / kCell_m) + 0.5) * kCell_m;
    }
    expected.insert(centre);
  }
  const std::vector<Eigen::Vector3d> found = occupied_centres(octree_of(block_and_post()), "a.bt");
  EXPECT_EQ(found.size(), expected.size());
  EXPECT_EQ(places_of(found), expected);
}

TEST(CellCentres, ComeBackFromTheFilesThatHoldThem) {
  for (const double east_m : {0.0, 500'000.0}) {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3d& point : block_and_post()) {
      points.emplace_back(point.x() + east_m, point.y(), point.z());
    }
    EXPECT_EQ(fit_in_floats(points), east_m == 0.0);
    for (const auto& [bytes, name] :
         {std::pair{points_as_pcd(points), "a.pcd"}, {points_as_ply(points), "a.ply"}}) {
      const PointCloud cloud = parse_point_cloud(bytes, name);
      ASSERT_EQ(cloud.points.size(), points.size()) << name;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT((cloud.in_source(i) - points[i]).cwiseAbs().maxCoeff(), 1e-4) << name;
      }
    }
  }
}

TEST(OccupancyGrid, IsWhatIsOccupiedOrFreeInAColumnOfItsHeights) {
  const OccupancyMap octree =
      octree_of({{4.25, 0.25, 0.25}, {4.25, 1.25, 5.25}}, Eigen::Vector3d(0.25, 0.25, 0.25));
  for (const GridHeights heights : {GridHeights{}, GridHeights{0.0, 1.0}, GridHeights{5.0, 6.0}}) {
    const OccupancyGrid grid = grid_from_above(octree, heights, "a.bt");
    std::size_t known = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      for (std::size_t column = 0; column < grid.columns; ++column) {
        CellState expected = CellState::unknown;
        for (double z = -2.25; z < 8.0; z += kCell_m) {
          if (z + 0.25 <= heights.from_m || z - 0.25 >= heights.to_m) continue;
          const Eigen::Vector3d at(
              grid.corner_in_source.x() + (static_cast<double>(column) + 0.5) * kCell_m,
              grid.corner_in_source.y() + (static_cast<double>(row) + 0.5) * kCell_m, z);
          expected = std::max(expected, octree.at(at));
        }
        EXPECT_EQ(grid.at(column, row), expected) << column << ", " << row;
        known += expected == CellState::unknown ? 0 : 1;
      }
    }
    EXPECT_GT(known, 0u);
  }
  EXPECT_THROW(grid_from_above(octree, {50.0, 60.0}, "a.bt"), InputError);
}

TEST(OccupancyGrid, IsAnImageWhoseFirstRowIsTheNorth) {
  const OccupancyGrid grid{.resolution_m = 0.5,
                           .corner_in_source = {-1.5, 20},
                           .columns = 3,
                           .rows = 2,
                           .squares = {CellState::occupied, CellState::free, CellState::unknown,
                                       CellState::unknown, CellState::free, CellState::free}};
  EXPECT_EQ(grid_as_pgm(grid),
            std::string("P5\n3 2\n255\n") + "\xCD\xFE\xFE" + std::string("\0\xFE\xCD", 3));
  EXPECT_EQ(grid_yaml(grid, "a.pgm"),
            "image: a.pgm\nmode: trinary\nresolution: 0.5\norigin: [-1.5, 20, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

/// Squares of 0.5 m with a wall, a beam above it, and free space: what a column of them holds.
struct Column {
  bool is_known = false, is_occupied = false;
  double lowest_m = 1e9, highest_m = -1e9;
};

// 2,001 by 2,001 squares of two cells, and 4,001 by 4,001.
TEST(GridRaster, IsRefusedWhereTwoCellsAreFarApart) {
  const auto squares = [](double far_m) {
    return raster_from_above(octree_of({{0.1, 0.1, 0.1}, {far_m, far_m, 0.1}}), {}, "a.bt").columns;
  };
  EXPECT_EQ(squares(1000.1), 2001u);
  EXPECT_THROW(squares(2000.1), InputError);
}

TEST(GridRaster, HasTheBandsThatEachColumnOfCellsSays) {
  const OccupancyMap octree = octree_of(block_and_post(), Eigen::Vector3d(0.1, 0.1, 0.7));
  const GridHeights heights{0.5, 1.5};
  const Raster raster = raster_from_above(octree, heights, "a.bt");
  ASSERT_EQ(raster.bands.size(), 4u);
  std::map<std::array<long, 2>, Column> columns;
  for (const OccupancyCell& leaf : octree.cells()) {
    const long side = std::lround(leaf.size_m / kCell_m);
    for (long i = 0; i < side * side * side; ++i) {
      const auto middle = [&](int axis, long k) {
        return leaf.centre_in_source[axis] - 0.5 * leaf.size_m + kCell_m * (double(k) + 0.5);
      };
      const double z = middle(2, i / side / side), half = 0.5 * kCell_m;
      if (z + half <= heights.from_m || z - half >= heights.to_m) continue;
      Column& column = columns[{std::lround((middle(0, i % side) - half) / kCell_m),
                                std::lround((middle(1, i / side % side) - half) / kCell_m)}];
      column.is_known = true;
      if (leaf.state != CellState::occupied) continue;
      column.is_occupied = true;
      column.lowest_m = std::min(column.lowest_m, z - half);
      column.highest_m = std::max(column.highest_m, z + half);
    }
  }
  std::size_t known = 0;
  for (std::size_t row = 0; row < raster.rows; ++row) {
    for (std::size_t column = 0; column < raster.columns; ++column) {
      const std::size_t i = row * raster.columns + column;
      const auto found = columns.find({std::lround(raster.corner.x() / kCell_m) + long(column),
                                       std::lround(raster.corner.y() / kCell_m) + long(row)});
      const Column expected = found == columns.end() ? Column{} : found->second;
      known += expected.is_known;
      EXPECT_EQ(!std::isnan(raster.bands[0].values[i]), expected.is_known);
      EXPECT_EQ(raster.bands[0].values[i] == 1.0f, expected.is_occupied);
      EXPECT_EQ(!std::isnan(raster.bands[1].values[i]), expected.is_occupied);
      if (expected.is_occupied) {
        EXPECT_NEAR(raster.bands[1].values[i], expected.lowest_m, 1e-6);
        EXPECT_NEAR(raster.bands[2].values[i], expected.highest_m, 1e-6);
      }
      double nearest_m = 1e9;
      for (const auto& [place, other] : columns) {
        if (!other.is_occupied) continue;
        const double dx = raster.corner.x() / kCell_m + double(column) - double(place[0]),
                     dy = raster.corner.y() / kCell_m + double(row) - double(place[1]);
        nearest_m = std::min(nearest_m, kCell_m * std::hypot(dx, dy));
      }
      EXPECT_NEAR(raster.bands[3].values[i], nearest_m, 1e-5);
    }
  }
  EXPECT_EQ(known, columns.size());
}

TEST(CellBoxes, HoldEachOccupiedCellOfTheHeightsOnceAndAreFew) {
  std::vector<Eigen::Vector3d> points = block_and_post();
  points.insert(points.end(), {{-4.1, 0.9, 1.1}, {-3.1, 1.9, 1.1}, {-3.1, 0.9, 2.1}});  // with gaps
  const OccupancyMap octree = octree_of(points);
  const CellGrid grid(octree);
  for (const GridHeights& heights : {GridHeights{}, GridHeights{0.6, 0.9}}) {
    const std::vector<CellBox> boxes = occupied_boxes(octree, heights, "a.bt");
    Places found, expected;
    for (const CellBox& box : boxes) {
      for (std::int64_t x = box.from[0]; x < box.to[0]; ++x) {
        for (std::int64_t y = box.from[1]; y < box.to[1]; ++y) {
          for (std::int64_t z = box.from[2]; z < box.to[2]; ++z) {
            const Eigen::Vector3d at = grid.corner_in_source({x, y, z}).array() + 0.5 * kCell_m;
            EXPECT_TRUE(found.insert({at.x(), at.y(), at.z()}).second);
          }
        }
      }
    }
    for (const Eigen::Vector3d& at : occupied_centres(octree, "a.bt")) {
      if (at.z() + 0.25 <= heights.from_m || at.z() - 0.25 >= heights.to_m) continue;
      expected.insert({at.x(), at.y(), at.z()});
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(boxes.size(), expected.size() == 16 ? 1u : 5u);
    const Layer layer = layer_of_boxes(octree, boxes);
    ASSERT_EQ(layer.features.size(), boxes.size());
    const Points& ring = layer.features.front().shape.front().front();
    EXPECT_EQ(ring[0].head<2>(), grid.corner_in_source(boxes.front().from).head<2>());
    EXPECT_EQ(ring[2].head<2>(), grid.corner_in_source(boxes.front().to).head<2>());
  }
}

TEST(OccupancyChanges, TellWhatIsFreeNowFromWhatNobodyLookedAt) {
  const Eigen::Vector3d sensor(0.25, 0.25, 0.25), near(4.25, 0.25, 0.25), far(9.25, 0.25, 0.25),
      aside(4.25, 6.25, 0.25);
  const OccupancyMap before = octree_of({near, aside}, sensor), now = octree_of({far}, sensor);
  const OccupancyChanges changes = changes_between(before, "a.bt", now, "b.bt");
  EXPECT_EQ(places_of(changes.appeared), places_of({far}));
  EXPECT_EQ(places_of(changes.vanished), places_of({near}));
  EXPECT_EQ(changes.not_seen_again, 1u);
  EXPECT_EQ(changes.stayed, 0u);
  const OccupancyChanges none = changes_between(before, "a.bt", before, "a.bt");
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.stayed, 2u);
}

TEST(OccupancyChanges, AreRefusedBetweenCellsOfDifferentSize) {
  PointCloud cloud = cloud_of({{0.25, 0.25, 0.25}});
  const OccupancyMap fine = OccupancyMap::build({&cloud, 1}, {.resolution_m = 0.25});
  EXPECT_THROW(changes_between(fine, "a.bt", octree_of({{0.25, 0.25, 0.25}}), "b.bt"), InputError);
}

}  // namespace
}  // namespace roadbed::map
