#pragma once

// Private to map/occupancy.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/octree/bt_writer.h"
#include "roadbed/map/occupancy/octree/cell_key.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/map/occupancy/octree/octree_data.h"
#include "roadbed/map/occupancy/octree/scan_accumulator.h"

namespace roadbed::map::inline occupancy::inline octree {

/// What a file of OctoMap says is free and occupied, in six bytes for each inner node: three times
/// the data of a `.bt`, where nodes of OctoMap's own take 170 times. The log-odds of an `.ot` take
/// four bytes more for each leaf and inner node. Immutable.
class CompactOctree {
 public:
  static constexpr std::uint32_t kSide = 65536;  ///< cells of the root

  /// A cube of cells of one state.
  struct Leaf {
    std::array<std::uint32_t, 3> least;  ///< key of the cell in its lowest corner
    std::uint32_t side;                  ///< in cells, a power of two
    CellState state;
    float log_odds;  ///< of a `.bt`: what OctoMap clamps to
  };

  /// Keys of cells, both with it.
  struct KeyBox {
    CellKey least{0, 0, 0}, most{65535, 65535, 65535};
  };

  CompactOctree() = default;

  /// @param data  of a `.bt` with at least one node, as parse_octree_file has walked over it.
  /// @throws std::length_error over 2³² inner nodes.
  static CompactOctree of_bt(std::string_view data);

  /// The same of an `.ot`; log-odds of 0 and above are occupied, OctoMap's threshold.
  /// @throws std::length_error over 2³² nodes.
  static CompactOctree of_ot(std::string_view data);

  std::size_t leaves() const { return leaves_; }

  /// State of a cell. O(16).
  CellState at(const CellKey& key) const;

  /// Calls `use(leaf)` for those that meet a box, in OctoMap's order: x is the lowest bit of a
  /// child's number. O(leaves in the box).
  template <typename Use>
  void for_each(const KeyBox& box, Use&& use) const {
    if (!pairs_.empty()) visit(0, {0, 0, 0}, kSide, box, use);
  }

  /// The data of a `.bt`; eight equal leaves become one.
  OctreeBytes bt() const;

  /// The data of an `.ot`; where it comes from one, the same node for node.
  OctreeBytes ot() const;

 private:
  using Corner = std::array<std::uint32_t, 3>;

  static Corner corner_of(unsigned child, Corner corner, std::uint32_t side) {
    for (unsigned axis = 0; axis < 3; ++axis) corner[axis] += (child >> axis & 1u) * side;
    return corner;
  }

  static bool do_meet(const Corner& corner, std::uint32_t side, const KeyBox& box) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (corner[axis] > box.most[axis] || corner[axis] + side <= box.least[axis]) return false;
    }
    return true;
  }

  // By recursion, 16 levels at most.
  template <typename Use>
  void visit(std::uint32_t node, const Corner& corner, std::uint32_t side, const KeyBox& box,
             Use& use) const {
    const std::uint32_t half = side / 2;
    std::uint32_t inner = first_inner_[node], leaf = first_leaf(node);
    for (unsigned child = 0; child < 8; ++child) {
      const BtPair pair = pair_of(pairs_[node], child);
      if (pair == BtPair::unknown) continue;
      const std::uint32_t below = pair == BtPair::inner ? inner++ : leaf++;
      const Corner at = corner_of(child, corner, half);
      if (!do_meet(at, half, box)) continue;
      if (pair == BtPair::inner) {
        visit(below, at, half, box, use);
      } else {
        use(Leaf{at, half, pair == BtPair::free ? CellState::free : CellState::occupied,
                 log_odds_of(pair, below)});
      }
    }
  }

  std::uint32_t first_leaf(std::uint32_t node) const {
    return first_leaf_.empty() ? 0 : first_leaf_[node];
  }
  float log_odds_of(BtPair pair, std::uint32_t leaf) const {
    if (!log_odds_.empty()) return log_odds_[leaf];
    return pair == BtPair::free ? rule_.least : rule_.most;
  }

  /// Nodes as a `.bt` has them one after the other, and of each which its first leaf is.
  struct Reading {
    std::string_view data;
    std::span<const std::uint32_t> first_leaf = {};
    std::size_t node = 0;
  };
  static CompactOctree read(Reading from);
  void read_node(Reading& from, std::size_t node);
  BtPair write_bt(std::uint32_t node, BtWriter& writer) const;
  float write_ot(std::uint32_t node, OctreeBytes& bytes) const;

  // Of inner nodes: what each child is, and the first of its children that are inner nodes; they
  // stand one behind the other.
  std::vector<std::uint16_t> pairs_;
  std::vector<std::uint32_t> first_inner_;
  std::size_t leaves_ = 0;

  // Of an `.ot`: the first leaf among the children of each inner node, and the values of leaves.
  std::vector<std::uint32_t> first_leaf_;
  std::vector<float> log_odds_;
  LogOddsRule rule_ = LogOddsRule::of_octomap();
};

}  // namespace roadbed::map::occupancy::octree
