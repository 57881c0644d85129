#include "roadbed/map/compiled/compiled_map.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/reseal.h"

namespace roadbed::map {
namespace {

// Lanes of so many points that each fills some chunks of its own.
RoadMap long_lanes() {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  for (int lane = 1; lane <= 4; ++lane) {
    std::vector<Eigen::Vector2d> left, right;
    for (int i = 0; i < 6000; ++i) {
      left.emplace_back(0.1 * i, 3.5 - 3.5 * lane);
      right.emplace_back(0.1 * i, -3.5 * lane);
    }
    made.add_lane(road, std::to_string(-lane), left, right);
  }
  return made.build();
}

// Touches what callers can touch.
void use(const RoadMap& road_map) {
  for (const Lane& lane : road_map.lanes()) {
    road_map.graph().of(lane.id);
    road_map.find_lane(lane.name);
    road_map.locate(lane.pose_at(0.0).position(), 50.0, false);
  }
  EXPECT_LT(totals_of(road_map).lanes_of_type.size(), 100U);
  for (const Road& road : road_map.roads()) EXPECT_LE(road.lanes.size(), road_map.lanes().size());
}

TEST(CompiledMap, ReadsBackToTheSameBytes) {
  const std::string bytes = write_compiled_map(tests::curved_two_lane_road());
  EXPECT_EQ(write_compiled_map(read_compiled_map(bytes, "made.rbm")), bytes);
}

// Puts together what is written to it.
class Pieces : public ByteSink {
 public:
  void write(std::uint64_t offset, std::string_view piece) override {
    longest = std::max(longest, piece.size());
    if (offset + piece.size() > bytes.size()) bytes.resize(offset + piece.size());
    piece.copy(bytes.data() + offset, piece.size());
  }
  std::string bytes;
  std::size_t longest = 0;
};

TEST(CompiledMap, IsWrittenInPiecesOfAChunkThatMakeTheSameBytes) {
  const RoadMap made = long_lanes();
  Pieces pieces;
  write_compiled_map(made, "a routing section", pieces);
  EXPECT_EQ(pieces.bytes, write_compiled_map(made, "a routing section"));
  EXPECT_GT(pieces.bytes.size(), 10 * ChunkedFile::kChunkSize);
  EXPECT_EQ(pieces.longest, ChunkedFile::kChunkSize);
}

TEST(CompiledMap, KeepsEveryPointOfTheBorders) {
  const RoadMap made = tests::curved_two_lane_road();
  const RoadMap read = read_compiled_map(write_compiled_map(made), "made.rbm");
  ASSERT_EQ(read.lanes().size(), made.lanes().size());
  for (std::size_t i = 0; i < made.lanes().size(); ++i) {
    EXPECT_EQ(read.lanes()[i].left.in_map.points(), made.lanes()[i].left.in_map.points());
    EXPECT_EQ(read.lanes()[i].name, made.lanes()[i].name);
  }
}

TEST(CompiledMap, IsRefusedIfCutAtAnyByte) {
  const std::string bytes = write_compiled_map(tests::curved_two_lane_road());
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 16) {
    EXPECT_THROW(read_compiled_map(bytes.substr(0, size), "cut.rbm"), InputError) << size;
  }
}

TEST(CompiledMap, IsNotVerifiedIfAnyBitIsFlipped) {
  const std::string bytes = write_compiled_map(tests::curved_two_lane_road());
  EXPECT_GT(verify_compiled_map(bytes, "whole.rbm").records, 0U);
  std::mt19937 random(20261121);
  for (int i = 0; i < 500; ++i) {
    std::string changed = bytes;
    const std::size_t at = random() % changed.size();
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    EXPECT_THROW(verify_compiled_map(changed, "changed.rbm"), InputError) << "byte " << at;
  }
}

TEST(CompiledMap, OpensWithDamageInOneChunkAndRefusesOnlyWhatLiesThere) {
  std::string bytes = write_compiled_map(long_lanes());
  const std::string name = read_compiled_map(bytes, "whole.rbm").lanes()[0].name;
  bytes[bytes.rfind("1/0/-4")] = '7';  // the record of the last lane begins with its ids and name
  const RoadMap damaged = read_compiled_map(bytes, "damaged.rbm");
  EXPECT_EQ(damaged.lanes().size(), 4U);
  EXPECT_EQ(damaged.lanes()[0].name, name);
  EXPECT_THROW(damaged.lanes()[3], InputError);
}

TEST(CompiledMap, EndsInAnErrorWhereTheFileIsCutWhileOpen) {
  const tests::TemporaryFolder folder;
  const std::string bytes = write_compiled_map(long_lanes());
  const std::filesystem::path file = folder.write("long.rbm", bytes);
  const RoadMap open = open_compiled_map(file);
  std::filesystem::resize_file(file, bytes.size() / 4);
  EXPECT_THROW(use(open), InputError);
}

TEST(CompiledMap, EndsInAnErrorWhereTheFileIsOverwrittenWhileOpen) {
  const tests::TemporaryFolder folder;
  const std::string bytes = write_compiled_map(long_lanes());
  const std::filesystem::path file = folder.write("long.rbm", bytes);
  const RoadMap open = open_compiled_map(file);
  std::ofstream(file, std::ios::binary) << std::string(bytes.size(), 'x');
  EXPECT_THROW(use(open), InputError);
}

TEST(CompiledMap, WithRightChecksumsAndWrongContentIsUsableOrRefused) {
  const std::string bytes = write_compiled_map(tests::straight_two_lane_road().build());
  std::mt19937 random(20261121);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string changed = bytes;
    for (int k = 0; k < 3; ++k) {
      changed[48 + random() % (changed.size() - 48)] = static_cast<char>(random());
    }
    tests::reseal(changed);
    try {
      use(read_compiled_map(changed, "hostile.rbm"));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
}

TEST(CompiledMap, WithALinkToNoLaneIsNotVerified) {
  RoadMapParts parts = tests::straight_two_lane_road().parts;
  std::string bytes = write_compiled_map(RoadMap(parts));
  // The only list of one successor: its count, then the lane.
  parts.links[0].successors = {LaneId{1}};
  std::string linked = write_compiled_map(RoadMap(parts));
  EXPECT_EQ(verify_compiled_map(linked, "linked.rbm").records,
            verify_compiled_map(bytes, "unlinked.rbm").records);
  const std::string one_lane("\1\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\0\0\0\0", 20);
  const std::size_t at = linked.rfind(one_lane);
  ASSERT_NE(at, std::string::npos);
  linked[at + 8] = 2;
  tests::reseal(linked);
  EXPECT_THROW(verify_compiled_map(linked, "dangling.rbm"), InputError);
}

TEST(CompiledMap, WithAPlaceBeyondTheEarthIsNotVerified) {
  std::string bytes = write_compiled_map(tests::straight_two_lane_road(123.0).build());
  const double end_m = 123.0, far_m = 1e300;
  const std::string end(reinterpret_cast<const char*>(&end_m), sizeof end_m);
  const std::size_t at = bytes.rfind(end);  // x of a point of the last lane's polygon or line
  ASSERT_NE(at, std::string::npos);
  std::memcpy(bytes.data() + at, &far_m, sizeof far_m);
  tests::reseal(bytes);
  EXPECT_THROW(verify_compiled_map(bytes, "far.rbm"), InputError);
}

TEST(CompiledMap, AnswersAsTheMapThatItWasMadeOf) {
  const RoadMap made = tests::curved_two_lane_road();
  const RoadMap read = read_compiled_map(write_compiled_map(made), "made.rbm");
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> aside(-30.0, 30.0);
  for (const Lane& lane : made.lanes()) {
    EXPECT_EQ(read.find_lane(lane.name), lane.id);
    EXPECT_EQ(read.graph().of(lane.id).successors, made.graph().of(lane.id).successors);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d point =
          lane.pose_at(3.0 * i) * Eigen::Vector2d(aside(random), aside(random));
      const auto expected = made.locate(point, 40.0, false),
                 found = read.locate(point, 40.0, false);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].place.lane, expected[k].place.lane);
        EXPECT_EQ(found[k].place.s_m, expected[k].place.s_m);
        EXPECT_EQ(found[k].distance_m, expected[k].distance_m);
      }
    }
  }
  EXPECT_FALSE(read.find_lane("no such lane"));
}

TEST(CompiledMap, OfARealTownReadsBackToTheSameBytes) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const RoadMap town = load_map(real / "opendrive/BerkeleyLearnVerify+Scenic/Town01.xodr");
  const std::string bytes = write_compiled_map(town);
  EXPECT_EQ(write_compiled_map(parse_map(bytes, "town.rbm")), bytes);
}

}  // namespace
}  // namespace roadbed::map
