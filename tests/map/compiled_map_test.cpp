#include "roadbed/map/compiled_map.h"

#include <gtest/gtest.h>

#include <random>

#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

TEST(CompiledMap, ReadsBackToTheSameBytes) {
  const std::string bytes = write_compiled_map(tests::curved_two_lane_road());
  EXPECT_EQ(write_compiled_map(read_compiled_map(bytes, "made.rbm")), bytes);
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

TEST(CompiledMap, IsRefusedIfAnyBitIsFlipped) {
  const std::string bytes = write_compiled_map(tests::curved_two_lane_road());
  std::mt19937 random(20261121);
  for (int i = 0; i < 500; ++i) {
    std::string changed = bytes;
    const std::size_t at = random() % changed.size();
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    EXPECT_THROW(read_compiled_map(changed, "changed.rbm"), InputError) << "byte " << at;
  }
}

TEST(CompiledMap, OfARealTownReadsBackToTheSameBytes) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const RoadMap town = load_map(real / "opendrive/BerkeleyLearnVerify+Scenic/Town01.xodr");
  const std::string bytes = write_compiled_map(town);
  EXPECT_EQ(write_compiled_map(parse_map(bytes, "town.rbm")), bytes);
}

}  // namespace
}  // namespace roadbed::map
