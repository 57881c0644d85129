#include "roadbed/map/occupancy/octree/compact_octree.h"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::map {
namespace {

/// Leaves of all sizes, pruned or not, in a corner of OctoMap's range and around its middle.
octomap::OcTree random_tree(std::mt19937& random, int cells, bool is_pruned) {
  octomap::OcTree tree(0.25);
  std::uniform_int_distribution<int> near(32760, 32775), far(0, 20), state(0, 2);
  for (int i = 0; i < cells; ++i) {
    auto& place = i % 5 == 0 ? far : near;
    const auto coordinate = [&] { return static_cast<octomap::key_type>(place(random)); };
    const octomap::OcTreeKey key(coordinate(), coordinate(), coordinate());
    tree.setNodeValue(
        key, state(random) == 0 ? tree.getClampingThresMinLog() : tree.getClampingThresMaxLog(),
        true);
  }
  tree.updateInnerOccupancy();
  if (is_pruned) tree.prune();
  return tree;
}

using LeafOfOctomap = std::tuple<double, double, double, double, bool>;

std::vector<LeafOfOctomap> leaves_of(const octomap::OcTree& tree) {
  std::vector<LeafOfOctomap> leaves;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    leaves.emplace_back(leaf.getX(), leaf.getY(), leaf.getZ(), leaf.getSize(),
                        tree.isNodeOccupied(*leaf));
  }
  return leaves;
}

std::string file_of(const octomap::OcTree& tree, bool is_binary) {
  std::ostringstream out;
  if (is_binary) {
    tree.writeBinaryConst(out);
  } else {
    tree.write(out);
  }
  return out.str();
}

TEST(CompactOctree, HasTheLeavesOfOctomapBitForBitInItsOrder) {
  std::mt19937 random(20261125);
  for (int round = 0; round < 40; ++round) {
    const octomap::OcTree theirs = random_tree(random, 1 + 60 * round, round % 2 == 0);
    for (const bool is_binary : {false, true}) {
      const OccupancyMap ours = OccupancyMap::parse(file_of(theirs, is_binary), "a");
      std::vector<LeafOfOctomap> leaves;
      for (const OccupancyCell& cell : ours.cells()) {
        const Eigen::Vector3d& at = cell.centre_in_source;
        leaves.emplace_back(at.x(), at.y(), at.z(), cell.size_m, cell.state == CellState::occupied);
      }
      EXPECT_EQ(leaves, leaves_of(theirs));
      EXPECT_EQ(ours.node_count(), theirs.size());
    }
  }
}

TEST(CompactOctree, SaysOfEveryCellWhatOctomapSays) {
  std::mt19937 random(7);
  const octomap::OcTree theirs = random_tree(random, 3000, true);
  const OccupancyMap ours = OccupancyMap::parse(file_of(theirs, true), "a");
  for (int x = -12; x < 12; ++x) {
    for (int y = -12; y < 12; ++y) {
      for (int z = -12; z < 12; ++z) {
        const Eigen::Vector3d at = 0.25 * (Eigen::Vector3d(x, y, z).array() + 0.5);
        const octomap::OcTreeNode* node = theirs.search(at.x(), at.y(), at.z());
        const CellState expected = node == nullptr               ? CellState::unknown
                                   : theirs.isNodeOccupied(node) ? CellState::occupied
                                                                 : CellState::free;
        EXPECT_EQ(ours.at(at), expected) << at.transpose();
      }
    }
  }
}

TEST(CompactOctree, FindsInABoxExactlyTheLeavesThatMeetIt) {
  std::mt19937 random(3);
  const OccupancyMap map = OccupancyMap::parse(file_of(random_tree(random, 2000, true), true), "a");
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  for (int round = 0; round < 200; ++round) {
    const Eigen::Vector3d a(place(random), place(random), place(random));
    const Eigen::Vector3d b(place(random), place(random), place(random));
    const Box3 box{a.cwiseMin(b), a.cwiseMax(b)};
    std::vector<double> found, expected;
    for (const OccupancyCell& cell : map.cells_in(box))
      found.push_back(cell.centre_in_source.sum());
    for (const OccupancyCell& cell : map.cells()) {
      const Eigen::Array3d half = Eigen::Array3d::Constant(0.5 * cell.size_m);
      const Eigen::Array3d middle = cell.centre_in_source.array();
      if ((middle + half > box.min_in_source.array()).all() &&
          (middle - half < box.max_in_source.array()).all()) {
        expected.push_back(cell.centre_in_source.sum());
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(CompactOctree, KeepsTheLogOddsOfEveryLeaf) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> value(-1.9f, 3.4f);
  octomap::OcTree theirs = random_tree(random, 2000, true);
  for (auto leaf = theirs.begin_leafs(), end = theirs.end_leafs(); leaf != end; ++leaf) {
    leaf->setLogOdds(value(random));
  }
  theirs.updateInnerOccupancy();
  const std::string bytes = file_of(theirs, false);
  const OccupancyMap ours = OccupancyMap::parse(bytes, "a");
  auto leaf = theirs.begin_leafs();
  for (const OccupancyCell& cell : ours.cells()) EXPECT_EQ(cell.log_odds, (leaf++)->getLogOdds());
  const std::string written = ours.to_ot();
  EXPECT_EQ(written.substr(written.find("data\n")), bytes.substr(bytes.find("data\n")));
}

TEST(CompactOctree, WritesEightEqualLeavesAsOneOnEveryLevel) {
  // Pairs 01 are free: eight in each of eight in each child of the root.
  std::string data;
  const std::string full("\xff\xff", 2), free("\x55\x55", 2);
  data += full;
  for (int i = 0; i < 8; ++i) {
    data += full;
    for (int j = 0; j < 8; ++j) data += free;
  }
  const OctreeBytes pruned = CompactOctree::of_bt(data).bt();
  EXPECT_EQ(pruned.data, free);  // the root stays, as in OctoMap
  EXPECT_EQ(pruned.nodes, 9u);
}

TEST(CompactOctree, KeepsARootThatIsALeaf) {
  const std::string root = std::string("\0\0\x80\xbf\0", 5);  // -1, no children
  const OccupancyMap map =
      OccupancyMap::parse("# Octomap OcTree file\nid OcTree\nsize 1\nres 1\ndata\n" + root, "a");
  EXPECT_EQ(map.at({-100, 3, 30000}), CellState::free);
  EXPECT_EQ(OccupancyMap::parse(map.to_bt(), "b").at({-100, 3, 30000}), CellState::free);
}

}  // namespace
}  // namespace roadbed::map
