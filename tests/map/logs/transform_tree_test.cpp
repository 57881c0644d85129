#include "roadbed/map/logs/transform_tree.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace roadbed::map
