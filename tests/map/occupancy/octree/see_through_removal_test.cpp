#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/scan_accumulator.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

constexpr double kGrain_m = 0.2;

OccupancyOptions removing(int clouds) {
  return {.resolution_m = kGrain_m, .remove_seen_through = clouds};
}

/// A scan from somewhere low, of points on a wall and of some in between, which move.
PointCloud restless_scan(std::mt19937& random) {
  std::uniform_real_distribution<float> across(-1.5f, 1.5f), along(0.5f, 2.5f), up(-0.4f, 0.4f);
  PointCloud cloud;
  cloud.sensor_in_source = Eigen::Vector3d(across(random), -2.0, up(random));
  for (int i = 0; i < 60; ++i) {
    const bool is_wall = i % 5 != 0;
    cloud.points.emplace_back(across(random), is_wall ? 3.1f : along(random), up(random));
  }
  return cloud;
}

std::vector<PointCloud> restless_scans(std::mt19937& random, int count) {
  std::vector<PointCloud> clouds;
  for (int i = 0; i < count; ++i) clouds.push_back(restless_scan(random));
  return clouds;
}

template <typename Visit>
void for_each_cell(const Visit& visit) {
  for (double x = -1.9; x < 2.0; x += kGrain_m) {
    for (double y = -2.1; y < 3.4; y += kGrain_m) {
      for (double z = -0.5; z < 0.6; z += kGrain_m) visit(Eigen::Vector3d(x, y, z));
    }
  }
}

/// The rule, cell by cell, from what every cloud says alone.
CellState judged(const std::vector<OccupancyMap>& alone, const Eigen::Vector3d& cell, int least) {
  int hits = 0, through = 0;
  for (const OccupancyMap& cloud : alone) {
    hits += cloud.at(cell) == CellState::occupied;
    through += cloud.at(cell) == CellState::free;
  }
  if (hits == 0) return through == 0 ? CellState::unknown : CellState::free;
  return through >= least && through > hits ? CellState::free : CellState::occupied;
}

TEST(SeeThroughRemoval, TakesAwayJustTheHitsThatEnoughAndMoreCloudsSawThrough) {
  std::mt19937 random(21);
  for (const int least : {1, 2, 4}) {
    const auto clouds = restless_scans(random, 9);
    std::vector<OccupancyMap> alone;
    for (const PointCloud& cloud : clouds) {
      alone.push_back(OccupancyMap::build(std::vector{cloud}, {.resolution_m = kGrain_m}));
    }
    const auto file = OccupancyMap::build_bt(clouds, removing(least));
    const OccupancyMap together = OccupancyMap::parse(file.bytes, "made.bt");
    std::size_t removed = 0, kept = 0;
    for_each_cell([&](const Eigen::Vector3d& cell) {
      const CellState expected = judged(alone, cell, least);
      ASSERT_EQ(together.at(cell), expected) << cell.transpose();
      const bool was_hit = std::ranges::any_of(
          alone, [&](const OccupancyMap& map) { return map.at(cell) == CellState::occupied; });
      removed += was_hit && expected == CellState::free;
      kept += was_hit && expected == CellState::occupied;
    });
    EXPECT_EQ(file.seen_through, (SeeThroughRemoval{least, removed}));
    EXPECT_EQ(together.seen_through(), file.seen_through);
    EXPECT_EQ(OccupancyMap::build(clouds, removing(least)).to_bt(), file.bytes);
    EXPECT_EQ(together.to_bt(), file.bytes);
    EXPECT_EQ(OccupancyMap::parse(together.to_ot(), "a.ot").seen_through(), file.seen_through);
    EXPECT_GT(removed, 10u);
    EXPECT_GT(kept, 30u);
  }
}

TEST(SeeThroughRemoval, IsTheSameFileInWhateverOrderCloudsCome) {
  std::mt19937 random(22);
  auto clouds = restless_scans(random, 12);
  const std::string bytes = OccupancyMap::build_bt(clouds, removing(3)).bytes;
  for (int round = 0; round < 10; ++round) {
    std::ranges::shuffle(clouds, random);
    EXPECT_EQ(OccupancyMap::build_bt(clouds, removing(3)).bytes, bytes);
  }
}

TEST(SeeThroughRemoval, KeepsEveryHitAndSaysNothingUnlessItIsAskedFor) {
  std::mt19937 random(23);
  const auto clouds = restless_scans(random, 5);
  const auto sticky = OccupancyMap::build_bt(clouds, {.resolution_m = kGrain_m});
  EXPECT_FALSE(sticky.seen_through);
  EXPECT_FALSE(OccupancyMap::parse(sticky.bytes, "a.bt").seen_through());
  const auto in_vain = OccupancyMap::build_bt(clouds, removing(200));
  EXPECT_EQ(in_vain.seen_through, (SeeThroughRemoval{200, 0}));
  EXPECT_TRUE(in_vain.bytes.ends_with(sticky.bytes.substr(sticky.bytes.find("\ndata\n"))));
}

/// A wall of 8 m by 2 m behind y = 5 m, seen from the origin by ten clouds. In some of them a car
/// stands before it, and a pole of one cell is met by some rays.
struct Street {
  static constexpr int kClouds = 10;
  Eigen::Vector3d car{0.1, 3.1, 0.9}, pole{2.1, 2.5, 0.9};

  std::vector<PointCloud> scans(int with_car, int that_meet_the_pole) const {
    std::vector<PointCloud> clouds(kClouds);
    for (int i = 0; i < kClouds; ++i) {
      PointCloud& cloud = clouds[static_cast<std::size_t>(i)];
      cloud.sensor_in_source = Eigen::Vector3d(0.1, 0.1, 0.9);
      for (double x = -4.0; x < 4.0; x += 0.05) {
        for (double z = 0.05; z < 2.0; z += 0.05) {
          const Eigen::Vector3d way = Eigen::Vector3d(x, 5.1, z) - *cloud.sensor_in_source;
          const Eigen::Vector3d to_car = *cloud.sensor_in_source + way * (3.0 / way.y());
          const bool hits_car =
              i < with_car && std::abs(to_car.x()) < 1.0 && to_car.z() > 0.45 && to_car.z() < 1.35;
          cloud.points.push_back((hits_car ? to_car : Eigen::Vector3d(x, 5.1, z)).cast<float>());
        }
      }
      // One ray goes through the pole's cell: it ends there, or at the wall behind.
      const Eigen::Vector3d way = pole - *cloud.sensor_in_source;
      const Eigen::Vector3d behind = *cloud.sensor_in_source + way * (5.0 / way.y());
      cloud.points.push_back((i < that_meet_the_pole ? pole : behind).cast<float>());
    }
    return clouds;
  }
};

TEST(SeeThroughRemoval, ACarThatDrivesAwayVanishesAndTheWallBehindItStays) {
  const Street street;
  const auto clouds = street.scans(3, 0);
  const OccupancyMap sticky = OccupancyMap::build(clouds, {.resolution_m = kGrain_m});
  const OccupancyMap removed = OccupancyMap::build(clouds, removing(5));
  int car = 0, wall = 0;
  for (double x = -3.9; x < 4.0; x += kGrain_m) {
    for (double z = 0.1; z < 2.0; z += kGrain_m) {
      const Eigen::Vector3d at_car(x, 3.1, z), at_wall(x, 5.1, z);
      if (sticky.at(at_car) == CellState::occupied) {
        ++car;
        EXPECT_EQ(removed.at(at_car), CellState::free) << at_car.transpose();
      }
      ++wall;
      EXPECT_EQ(removed.at(at_wall), CellState::occupied) << at_wall.transpose();
    }
  }
  EXPECT_GT(car, 50);
  EXPECT_EQ(wall, 400);
}

TEST(SeeThroughRemoval, ACarThatStaysInMostCloudsStays) {
  const Street street;
  const OccupancyMap map = OccupancyMap::build(street.scans(6, 0), removing(3));
  EXPECT_EQ(map.at(street.car), CellState::occupied);
}

TEST(SeeThroughRemoval, APoleThatMostCloudsMissGoesTooAndStaysWhereMoreAreAskedFor) {
  const Street street;
  const auto clouds = street.scans(0, 3);
  EXPECT_EQ(OccupancyMap::build(clouds, {.resolution_m = kGrain_m}).at(street.pole),
            CellState::occupied);
  EXPECT_EQ(OccupancyMap::build(clouds, removing(7)).at(street.pole), CellState::free);
  EXPECT_EQ(OccupancyMap::build(clouds, removing(8)).at(street.pole), CellState::occupied);
}

TEST(SeeThroughRemoval, RaysOfOneCloudCountOnceHoweverManyPlacesTheyComeFrom) {
  std::string shots = "x,y,z,sensor_x,sensor_y,sensor_z\n";
  for (int i = 0; i < 30; ++i) {
    shots += "3.1,0.1,0.1,-" + std::to_string(i) + ".5,0.1,0.1\n";
  }
  PointCloud post = parse_point_cloud("1.1 0.1 0.1\n", "post.xyz");
  const std::vector<PointCloud> clouds{post, parse_point_cloud(shots, "shots.csv")};
  EXPECT_EQ(OccupancyMap::build(clouds, removing(1)).at({1.1, 0.1, 0.1}), CellState::occupied);
  const std::vector<PointCloud> twice{post, clouds[1], clouds[1]};
  EXPECT_EQ(OccupancyMap::build(twice, removing(2)).at({1.1, 0.1, 0.1}), CellState::free);
  EXPECT_EQ(OccupancyMap::build(twice, removing(3)).at({1.1, 0.1, 0.1}), CellState::occupied);
}

TEST(SeeThroughRemoval, IsRefusedWithLogOddsAndBeyondItsCounts) {
  const std::vector<PointCloud> clouds{parse_point_cloud("1 2 3\n", "a.xyz")};
  for (const int count : {-1, 256}) {
    EXPECT_THROW(OccupancyMap::build(clouds, removing(count)), std::invalid_argument);
  }
  OccupancyOptions options = removing(1);
  options.sticky_hits = false;
  EXPECT_THROW(OccupancyMap::build(clouds, options), std::invalid_argument);
}

TEST(SeeThroughRemoval, IsRefusedInAHeaderThatDoesNotSayIt) {
  const std::string bytes =
      OccupancyMap::build_bt(std::vector{parse_point_cloud("1 2 3\n", "a.xyz")}, removing(4)).bytes;
  const std::string line = "# roadbed seen-through 4 removed 0\n";
  const std::size_t at = bytes.find(line);
  ASSERT_NE(at, std::string::npos);
  for (const char* bad :
       {"# roadbed seen-through\n", "# roadbed seen-through 300 removed 0\n",
        "# roadbed seen-through 4 removed -1\n", "# roadbed seen-through 4 kept 1\n"}) {
    std::string changed = bytes;
    changed.replace(at, line.size(), bad);
    try {
      OccupancyMap::parse(changed, "a.bt");
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.bt:3: seen-through"));
    }
  }
}

TEST(BlockCounts, CountUpTo255AndCompareAsNumbersDo) {
  std::mt19937 random(24);
  std::array<BlockCounts, 2> counts;
  std::array<std::array<unsigned, 512>, 2> numbers{};
  for (int round = 0; round < 400; ++round) {
    for (std::size_t which = 0; which < 2; ++which) {
      BlockBits bits{};
      for (std::size_t cell = 0; cell < 512; ++cell) {
        if (random() % 512 > cell) continue;  // cells count more often the later they are
        bits[cell / 64] |= std::uint64_t{1} << cell % 64;
        numbers[which][cell] = std::min(numbers[which][cell] + 1, BlockCounts::kMost);
      }
      counts[which].add(bits);
    }
    if (round % 50 != 49) continue;
    const auto is_set = [](const BlockBits& bits, std::size_t cell) {
      return (bits[cell / 64] >> cell % 64 & 1u) != 0;
    };
    const auto more = counts[0].more_than(counts[1]);
    for (std::size_t cell = 0; cell < 512; ++cell) {
      EXPECT_EQ(is_set(more, cell), numbers[0][cell] > numbers[1][cell]);
      for (const unsigned count : {0u, 1u, 7u, 100u, 254u, 255u}) {
        EXPECT_EQ(is_set(counts[0].more_than(count), cell), numbers[0][cell] > count);
      }
    }
  }
}

}  // namespace
}  // namespace roadbed::map
