#include "roadbed/map/logs/transform_tree.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map {
namespace {

/// f1 stands in map, f2 in f1, and so on.
TransformTree chain_of(int frames) {
  TransformTree tree;
  for (int i = 1; i <= frames; ++i) {
    const std::string parent = i == 1 ? "map" : fmt::format("f{}", i - 1);
    tree.add({.parent = parent, .child = fmt::format("f{}", i), .child_in_parent = {}}, "tf", true);
  }
  return tree;
}

// A chain is climbed for each of the log's messages.
TEST(TransformTree, IsNoDeeperThanAnyVehicleIs) {
  EXPECT_EQ(chain_of(200).way_up("f200", "log", "--topic").size(), 200u);
  try {
    chain_of(300).way_up("f300", "log", "--topic");
    ADD_FAILURE() << "was climbed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("frame f300: stands in more than 256 frames"));
  }
}

// Above f3 is what the first tree says, below and beside it what the second says.
TEST(TransformTree, GoesOnInAnotherForFramesThatItDoesNotHave) {
  const auto below = std::make_shared<TransformTree>(chain_of(5));
  TransformTree above;
  above.add({.parent = "world", .child = "f3", .child_in_parent = {}}, "poses", false);
  above.sort();
  TransformTree without = above;
  above.go_on_in(below, "f3");
  EXPECT_EQ(above.way_up("f5", "log", "--topic"), (std::vector<std::string>{"f5", "f4", "f3"}));
  EXPECT_EQ(above.parent_of("f3"), "world");
  EXPECT_EQ(above.way_up("f2", "log", "--topic"), (std::vector<std::string>{"f2", "f1"}));
  without.go_on_in(below, "f4");  // which now says something else of f3
  EXPECT_FALSE(without.has("f4"));
  EXPECT_THROW(without.way_up("f3", "log", "--topic"), InputError);
}

}  // namespace
}  // namespace roadbed::map
