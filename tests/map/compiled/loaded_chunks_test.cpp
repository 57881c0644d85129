#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/storage/flat_array.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

constexpr double kRoad_m = 100.0;

/// One-lane roads of 100 m eastwards, one behind the other from `from_m` on, 4 m wide, a vertex
/// every 0.25 m: some 50 KB each.
std::string row_of_roads(int count, double from_m) {
  tests::MadeMap made;
  for (int i = 0; i < count; ++i) {
    const RoadId road = made.add_road(std::to_string(i));
    std::vector<Eigen::Vector2d> left, right;
    for (int k = 0; k <= 400; ++k) {
      left.emplace_back(from_m + kRoad_m * i + 0.25 * k, 2.0);
      right.emplace_back(left.back().x(), -2.0);
    }
    const LaneId lane = made.add_lane(road, "-1", left, right);
    if (i > 0) made.link(LaneId{lane.index - 1}, lane);
  }
  return write_compiled_map(made.build());
}

/// Asks at every metre of a drive along the row which lanes are within `reach_m`, and for all of
/// what is there.
std::size_t lanes_met(const RoadMap& road_map, double from_m, double to_m, double reach_m) {
  std::size_t met = 0;
  for (double x_m = from_m; x_m <= to_m; x_m += 1.0) {
    for (const LaneMatch& match : road_map.locate({x_m, 0.3}, reach_m, true)) {
      const Lane& lane = road_map.lane(match.place.lane);
      met += road_map.road(*lane.road).lanes.size();
      EXPECT_LE(road_map.graph().of(lane.id).successors.size(), 1U);
    }
  }
  return met;
}

TEST(LoadedChunks, OfADriveAreThoseThatItsNeighbourhoodFills) {
  constexpr double kFrom_m = 8030.0, kTo_m = 9030.0, kReach_m = 20.0;
  const RoadMap row = read_compiled_map(row_of_roads(160, 0.0), "row.rbm");
  // The roads that come within reach, as a map of their own: what is loaded of the row is no more
  // than all of that map, and a chunk more at either end of each list that is asked.
  const RoadMap alone = read_compiled_map(row_of_roads(11, 8000.0), "alone.rbm");
  EXPECT_EQ(lanes_met(row, kFrom_m, kTo_m, kReach_m), lanes_met(alone, kFrom_m, kTo_m, kReach_m));
  const LoadedChunks of_row = loaded_chunks(row);
  constexpr std::size_t kLists = 14;  // head, seven of the index, roads, lanes, links and places
  EXPECT_LE(of_row.loaded, loaded_chunks(alone).of + 2 * kLists);
  EXPECT_GT(of_row.of, 3 * of_row.loaded);
}

TEST(LoadedChunks, AreHardlyMoreForAMapTwiceAsLarge) {
  const RoadMap row = read_compiled_map(row_of_roads(40, 0.0), "row.rbm"),
                longer = read_compiled_map(row_of_roads(80, 0.0), "longer.rbm");
  EXPECT_EQ(loaded_chunks(row).loaded, loaded_chunks(longer).loaded);
  lanes_met(row, 1030.0, 1230.0, 20.0);
  lanes_met(longer, 1030.0, 1230.0, 20.0);
  EXPECT_GT(loaded_chunks(longer).of, loaded_chunks(row).of * 19 / 10);
  EXPECT_LE(loaded_chunks(longer).loaded, loaded_chunks(row).loaded + 4);
}

TEST(LoadedChunks, ThatWereLetGoComeBackTheSame) {
  const auto file = ChunkedFile::from_bytes(row_of_roads(4, 0.0), "row.rbm");
  const FlatArray<char> lanes(file, "lanes");
  const std::string before(lanes.bytes());
  EXPECT_GT(file->chunks_in_memory(), 1U);
  file->evict_all();
  EXPECT_EQ(file->chunks_in_memory(), 0U);
  EXPECT_EQ(lanes.bytes(), before);
}

TEST(LoadedChunks, AreNoneOfAMapThatIsNotCompiled) {
  EXPECT_EQ(loaded_chunks(tests::straight_two_lane_road().build()).of, 0U);
}

}  // namespace
}  // namespace roadbed::map
