#include "roadbed/map/occupancy/octree/tiled_occupancy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/tile_builder.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

constexpr HeightBand kHeights{0.2, 1.5};
constexpr double kSide_m = 0.1;

/// A folder of its own for a test.
class TiledOccupancyTest : public testing::Test {
 protected:
  TiledOccupancyTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("tiles_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TiledOccupancyTest() override { std::filesystem::remove_all(folder_); }

  void put(const std::string& file, std::string_view bytes) const {
    std::ofstream(folder_ / file, std::ios::binary) << bytes;
  }

  TilesIndex build(const std::vector<PointCloud>& clouds, std::int64_t side_cells,
                   std::size_t most_bytes, const OccupancyOptions& options = {}) const {
    Box3 all = bounds(clouds.front());
    std::size_t most_points = 0;
    for (const PointCloud& cloud : clouds) {
      all.min_in_source = all.min_in_source.cwiseMin(bounds(cloud).min_in_source);
      all.max_in_source = all.max_in_source.cwiseMax(bounds(cloud).max_in_source);
      most_points = std::max(most_points, cloud.points.size());
    }
    TileBuilder builder({.folder = folder_,
                         .resolution_m = kSide_m,
                         .carve_range_m = options.carve_range_m,
                         .sticky_hits = options.sticky_hits,
                         .remove_seen_through = options.remove_seen_through,
                         .origin_in_source = tree_origin(all, kSide_m),
                         .crs = "EPSG:25832",
                         .side_cells = side_cells,
                         .most_points = most_points,
                         .most_bytes = most_bytes});
    for (const PointCloud& cloud : clouds) builder.add(cloud);
    const TilesIndex index =
        builder.finish([&](const std::string& file, std::string_view bytes) { put(file, bytes); });
    put("index.json", write_tiles_index(index));
    return index;
  }

  std::filesystem::path folder_;
};

std::vector<PointCloud> scans_around(std::mt19937& random, const Eigen::Vector3d& around,
                                     double extent_m) {
  std::uniform_real_distribution<double> place(-extent_m, extent_m), height(0.0, 3.0);
  std::vector<PointCloud> clouds;
  for (int scan = 0; scan < 8; ++scan) {
    PointCloud cloud;
    cloud.origin_in_source = around;
    if (scan % 4 != 0) {
      cloud.sensor_in_source =
          around + Eigen::Vector3d(place(random), place(random), height(random));
    }
    for (int i = 0; i < 80; ++i) {
      cloud.points.push_back(
          Eigen::Vector3d(place(random), place(random), height(random)).cast<float>());
    }
    cloud.crs = "EPSG:25832";
    clouds.push_back(cloud);
  }
  return clouds;
}

/// Leaves taken apart into cells of the finest level.
std::map<std::array<std::int64_t, 3>, CellState> finest(const OccupancySource& source) {
  std::map<std::array<std::int64_t, 3>, CellState> cells;
  for (const OccupancyCell& leaf : source.cells()) {
    const Eigen::Array3d corner =
        (leaf.centre_in_source - source.origin_in_source()).array() / kSide_m -
        0.5 * leaf.size_m / kSide_m;
    const auto side = std::llround(leaf.size_m / kSide_m);
    for (std::int64_t i = 0; i < side * side * side; ++i) {
      cells[{std::llround(corner.x()) + i % side, std::llround(corner.y()) + i / side % side,
             std::llround(corner.z()) + i / (side * side)}] = leaf.state;
    }
  }
  return cells;
}

TEST_F(TiledOccupancyTest, HoldsTheCellsOfTheWholeWhateverTheSideAndTheMemory) {
  std::mt19937 random(20261122);
  for (const std::int64_t side : {64, 128, 1024}) {
    for (const std::size_t most_bytes : {std::size_t{1}, std::size_t{500'000}}) {
      const auto clouds = scans_around(random, {500'000.0, 5'800'000.0, 100.0}, 14.0);
      const OccupancyMap whole = OccupancyMap::build(clouds, {.resolution_m = kSide_m});
      build(clouds, side, most_bytes);
      const TiledOccupancy tiles(folder_);
      EXPECT_EQ(tiles.crs(), whole.crs());
      EXPECT_EQ(tiles.origin_in_source(), whole.origin_in_source());
      ASSERT_EQ(finest(tiles), finest(whole));
      EXPECT_TRUE(tiles.bounds()->min_in_source.isApprox(whole.bounds()->min_in_source, 1e-12));
      EXPECT_TRUE(tiles.bounds()->max_in_source.isApprox(whole.bounds()->max_in_source, 1e-12));
    }
  }
}

TEST_F(TiledOccupancyTest, HoldsTheCellsOfTheWholeByLogOddsAndWithoutWhatWasSeenThrough) {
  std::mt19937 random(20261123);
  for (const std::int64_t side : {64, 256}) {
    for (const double range_m : {1e9, 4.0}) {
      const auto clouds = scans_around(random, {500'000.0, 5'800'000.0, 100.0}, 6.0);
      for (const int removed : {0, 1, 2}) {
        const OccupancyOptions options{.resolution_m = kSide_m,
                                       .carve_range_m = range_m,
                                       .sticky_hits = removed > 0,
                                       .remove_seen_through = removed};
        const OccupancyMap whole = OccupancyMap::build(clouds, options);
        build(clouds, side, 500'000, options);
        const TiledOccupancy tiles(folder_);
        ASSERT_EQ(finest(tiles), finest(whole));
        EXPECT_EQ(tiles.seen_through(), whole.seen_through());
        EXPECT_EQ(tiles.seen_through().has_value(), removed > 0);
        if (removed == 1) {
          EXPECT_GT(tiles.seen_through()->cells, 0u);
        }
      }
    }
  }
}

TEST_F(TiledOccupancyTest, LeavesNothingInItsFolderButTilesOfTheIndex) {
  std::mt19937 random(2);
  const TilesIndex index = build(scans_around(random, {0, 0, 0}, 10.0), 64, 1);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    ++files;
    EXPECT_NE(entry.path().extension(), ".aside");
  }
  EXPECT_EQ(files, index.tiles.size() + 1);
  EXPECT_GT(index.tiles.size(), 4u);
}

TEST_F(TiledOccupancyTest, AFieldOverItSaysWhatOneOverTheWholeSaysBitForBit) {
  std::mt19937 random(3);
  const Eigen::Vector3d middle(500'000.0, 5'800'000.0, 0.0);
  const auto clouds = scans_around(random, middle, 16.0);
  const OccupancyMap whole = OccupancyMap::build(clouds, {.resolution_m = kSide_m});
  build(clouds, 64, 1'000'000);
  const TiledOccupancy tiles(folder_);
  const Eigen::Vector2d at = middle.head<2>();
  FieldRegion region{.around = {at.array() - 20.0, at.array() + 20.0}, .horizon_m = 8.0};
  const ClearanceField expected(whole, kHeights, region);
  region.tile_m = 3.0;
  const ClearanceField field(tiles, kHeights, region);
  std::uniform_real_distribution<double> place(-15.0, 15.0), turn(-4.0, 4.0);
  for (int i = 0; i < 150; ++i) {
    const geometry::Pose2 pose{at.x() + place(random), at.y() + place(random), turn(random)};
    for (const ObstacleKind kind : {ObstacleKind::occupied, ObstacleKind::unknown}) {
      ASSERT_EQ(field.distance_bound_m(pose.position(), kind),
                expected.distance_bound_m(pose.position(), kind));
      const auto a = field.nearest(pose, {}, 8.0, kind), b = expected.nearest(pose, {}, 8.0, kind);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      ASSERT_EQ(a->distance_m, b->distance_m);
      ASSERT_EQ(a->witness.min_in_source, b->witness.min_in_source);
    }
    ASSERT_EQ(field.unknown_fraction(pose, {}), expected.unknown_fraction(pose, {}));
  }
}

TEST_F(TiledOccupancyTest, ReadsOnlyTilesThatABoxMeets) {
  PointCloud cloud;
  for (int i = 0; i < 40; ++i) cloud.points.emplace_back(10.0f * static_cast<float>(i), 1.0f, 1.0f);
  const TilesIndex index = build({cloud}, 64, 1'000'000);
  EXPECT_EQ(index.tiles.size(), 40u);
  const TiledOccupancy tiles(folder_);
  EXPECT_EQ(tiles.cells_in({{95.0, 0.0, 0.0}, {125.0, 2.0, 2.0}}).size(), 3u);
  EXPECT_EQ(tiles.tiles_read(), 4u);  // the box meets the square of one more
  tiles.cells_in({{95.0, 0.0, 0.0}, {125.0, 2.0, 2.0}});
  EXPECT_EQ(tiles.tiles_read(), 4u);  // the box meets the square of one more
}

TEST_F(TiledOccupancyTest, MayBeLargerThanAnOctreesRange) {
  std::vector<PointCloud> clouds(3);
  for (int i = 0; i < 3; ++i) {
    PointCloud& cloud = clouds[static_cast<std::size_t>(i)];
    cloud.origin_in_source = {12'000.0 * i, -7'000.0 * i, 0.0};
    cloud.sensor_in_source = cloud.origin_in_source + Eigen::Vector3d(0.05, 0.05, 1.05);
    cloud.points.emplace_back(5.05f, 0.05f, 1.05f);
  }
  EXPECT_THROW(OccupancyMap::build(clouds, {.resolution_m = kSide_m}), InputError);
  build(clouds, 256, 1'000'000);
  const TiledOccupancy tiles(folder_);
  std::size_t hits = 0, free = 0;
  for (const auto& [at, state] : finest(tiles)) {
    (state == CellState::occupied ? hits : free) += 1;
  }
  EXPECT_EQ(hits, 3u);
  EXPECT_EQ(free, 3u * 50u);
  for (const PointCloud& cloud : clouds) {
    const Eigen::Vector3d hit = cloud.in_source(0);
    const auto cells = tiles.cells_in({hit.array() - 0.01, hit.array() + 0.01});
    EXPECT_THAT(cells, testing::Contains(testing::Truly([&](const OccupancyCell& cell) {
                  return cell.state == CellState::occupied &&
                         (cell.centre_in_source - hit).norm() < 0.1;
                })));
  }
}

/// Hits along 20 km, and what is around the sensors that come with every few of them.
PointCloud long_cloud(bool has_sensors) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> aside(-8.0, 8.0), height(0.0, 3.0);
  PointCloud cloud;
  cloud.origin_in_source = {1'000.0, -2'000.0, 0.0};
  for (int i = 0; i < 2000; ++i) {
    if (has_sensors && i % 5 == 0) {
      cloud.scans.push_back(
          {cloud.points.size(), cloud.origin_in_source + Eigen::Vector3d(10.0 * i, -5.0 * i, 1.5)});
    }
    cloud.points.emplace_back(static_cast<float>(10.0 * (i - i % 5) + aside(random)),
                              static_cast<float>(-5.0 * (i - i % 5) + aside(random)),
                              static_cast<float>(height(random)));
  }
  return cloud;
}

TEST_F(TiledOccupancyTest, TakesOneCloudThatIsLargerThanAnOctreesRange) {
  for (const bool has_sensors : {false, true}) {
    const PointCloud cloud = long_cloud(has_sensors);
    EXPECT_THROW(OccupancyMap::build(std::vector{cloud}, {.resolution_m = kSide_m}), InputError);
    build({cloud}, 1024, 1'000'000);
    const TiledOccupancy tiles(folder_);
    std::set<std::array<std::int64_t, 3>> hit;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const Eigen::Array3d cells =
          ((cloud.in_source(i) - tiles.origin_in_source()) / kSide_m).array().floor();
      hit.insert({static_cast<std::int64_t>(cells.x()), static_cast<std::int64_t>(cells.y()),
                  static_cast<std::int64_t>(cells.z())});
    }
    std::size_t hits = 0, free = 0;
    for (const auto& [at, state] : finest(tiles)) {
      (state == CellState::occupied ? hits : free) += 1;
    }
    EXPECT_EQ(hits, hit.size());
    EXPECT_EQ(free > 0, has_sensors);
  }
}

TEST_F(TiledOccupancyTest, RefusesACloudWhosePointsAreTooFarApartToBeKnown) {
  PointCloud cloud = long_cloud(false);
  cloud.points.emplace_back(0.0f, 26'000.0f, 0.0f);  // of 262,144 cells
  EXPECT_NO_THROW(build({cloud}, 1024, 1'000'000));
  cloud.points.emplace_back(0.0f, 27'000.0f, 0.0f);
  EXPECT_THROW(build({cloud}, 1024, 1'000'000), InputError);
}

TEST_F(TiledOccupancyTest, RefusesALargeCloudWithSensorsWhereCloudsCount) {
  EXPECT_THROW(build({long_cloud(true)}, 1024, 1'000'000, {.remove_seen_through = 3}), InputError);
  EXPECT_NO_THROW(build({long_cloud(false)}, 1024, 1'000'000, {.remove_seen_through = 3}));
}

TEST_F(TiledOccupancyTest, RefusesTilesThatAreNotThoseOfTheIndex) {
  std::mt19937 random(4);
  const TilesIndex index = build(scans_around(random, {0, 0, 0}, 10.0), 64, 1'000'000);
  const auto message = [&] {
    try {
      TiledOccupancy(folder_).cells();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(message(), "nothing");
  put(index.tiles[1].file, "# Octomap OcTree binary file\n");
  EXPECT_THAT(message(), HasSubstr("as the index says"));
  std::filesystem::remove(folder_ / index.tiles[1].file);
  EXPECT_THAT(message(), HasSubstr("no such file"));
}

TEST_F(TiledOccupancyTest, TakesNothingOfWhatAKilledRunLeftBehind) {
  PointCloud cloud;
  cloud.points.emplace_back(1.0f, 1.0f, 1.0f);
  put("tile_0_0.aside", std::string(5 * 144, '\x7f'));
  build({cloud}, 64, 1);
  EXPECT_EQ(finest(TiledOccupancy(folder_)).size(), 1u);
}

TEST_F(TiledOccupancyTest, RefusesAnIndexThatIsWrongAboutATile) {
  std::mt19937 random(6);
  const TilesIndex good = build(scans_around(random, {0, 0, 0}, 10.0), 64, 1'000'000);
  const auto refuses = [&](const std::function<void(TilesIndex&)>& spoil) {
    TilesIndex bad = good;
    spoil(bad);
    put("index.json", write_tiles_index(bad));
    try {
      TiledOccupancy(folder_).cells();
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refuses([](TilesIndex&) {}));
  EXPECT_TRUE(refuses([](TilesIndex& index) { index.resolution_m = 0.2; }));
  EXPECT_TRUE(refuses([](TilesIndex& index) { index.origin_in_source.x() += 0.1; }));
  EXPECT_TRUE(refuses([](TilesIndex& index) { index.side_cells = 128; }));
  EXPECT_TRUE(refuses([](TilesIndex& index) { index.tiles[0].bounds.max_in_source.x() -= 1.0; }));
  EXPECT_TRUE(refuses([](TilesIndex& index) { index.tiles.push_back(index.tiles[0]); }));
}

TEST(TilesIndex, IsReadAsItWasWritten) {
  const TilesIndex index{.resolution_m = 0.1,
                         .origin_in_source = {0.1, -1e6 / 3.0, 7.0},
                         .crs = "EPSG:25832",
                         .side_cells = 256,
                         .tiles = {{.x = -3,
                                    .y = 12,
                                    .file = "tile_-3_12.bt",
                                    .nodes = 17,
                                    .sha256 = "0123456789abcdef",
                                    .bounds = {{-1.0 / 3.0, 0, 0}, {1, 2, 3}}}}};
  const TilesIndex read = parse_tiles_index(write_tiles_index(index), "index.json");
  EXPECT_EQ(read.resolution_m, index.resolution_m);
  EXPECT_EQ(read.origin_in_source, index.origin_in_source);
  EXPECT_EQ(read.crs, index.crs);
  EXPECT_EQ(read.side_cells, index.side_cells);
  ASSERT_EQ(read.tiles.size(), 1u);
  EXPECT_EQ(read.tiles[0].x, -3);
  EXPECT_EQ(read.tiles[0].nodes, 17u);
  EXPECT_EQ(read.tiles[0].sha256, index.tiles[0].sha256);
  EXPECT_EQ(read.tiles[0].bounds.min_in_source, index.tiles[0].bounds.min_in_source);
}

TEST(TilesIndex, RefusesWhatIsNone) {
  const std::string good = write_tiles_index({.resolution_m = 0.1,
                                              .origin_in_source = {0, 0, 0},
                                              .crs = "",
                                              .side_cells = 256,
                                              .tiles = {{.x = 0,
                                                         .y = 0,
                                                         .file = "tile_0_0.bt",
                                                         .nodes = 1,
                                                         .sha256 = "00",
                                                         .bounds = {{0, 0, 0}, {1, 1, 1}}}}});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_NO_THROW(parse_tiles_index(good, "index.json"));
  for (const std::string& bad :
       {std::string("{"), std::string("[]"), with("tiles 2", "tiles 1"), with("tiles 2", "tiles 9"),
        with("0.1", "-1.0"), with("256", "100"), with("tile_0_0.bt", "../secret.bt"),
        with("\"x\": 0", "\"x\": 0.5"), with("\"tiles\": [", "\"tile\": ["),
        with("\"crs\"", "\"side_cells\": 64, \"crs\""),
        with("\"crs\"", "\"seen_through\": {\"clouds\": 0, \"removed_cells\": 1}, \"crs\""),
        with("\"crs\"", "\"seen_through\": 3, \"crs\""),
        with("\"sha256\": \"00\"", "\"sha256\": 0"), with("sha256", "xxhash")}) {
    EXPECT_THROW(parse_tiles_index(bad, "index.json"), InputError) << bad;
  }
}

}  // namespace
}  // namespace roadbed::map
