#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>

namespace roadbed::map::inline gis {

/// Children of a node of FlatGeobuf's index.
constexpr std::uint16_t kPackedTreeNode = 16;

/// A feature in the index: its box and the byte at which it begins, counted from the first one.
struct PackedTreeLeaf {
  Eigen::AlignedBox2d box;
  std::uint64_t offset = 0;
};

/// FlatGeobuf's index of boxes as bytes: from the root to the leaves level by level, per node its
/// box and the number of its first child, or the leaf's offset. Empty for no leaves.
std::string packed_tree(std::span<const PackedTreeLeaf> leaves);

}  // namespace roadbed::map::gis
