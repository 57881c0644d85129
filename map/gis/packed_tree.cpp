#include "roadbed/map/gis/packed_tree.h"

#include <cstring>
#include <utility>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"

namespace roadbed::map::inline gis {
namespace {

template <typename T>
void add_raw(T value, std::string& bytes) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void add_node(const geometry::Box& box, std::uint64_t child, std::string& bytes) {
  for (const double side : {box.min().x(), box.min().y(), box.max().x(), box.max().y()}) {
    add_raw(side, bytes);
  }
  add_raw(child, bytes);
}

}  // namespace

std::string packed_tree(std::span<const PackedTreeLeaf> leaves) {
  if (leaves.empty()) return {};
  std::vector<geometry::Box> boxes;
  for (const PackedTreeLeaf& leaf : leaves) boxes.push_back(leaf.box);
  const auto levels = geometry::packed_levels(std::move(boxes), kPackedTreeNode);
  std::string bytes;
  std::uint64_t nodes = 0;  // up to the level below
  for (std::size_t level = levels.size() - 1; level > 0; --level) {
    nodes += levels[level].size();
    for (std::size_t i = 0; i < levels[level].size(); ++i) {
      add_node(levels[level][i], nodes + i * kPackedTreeNode, bytes);
    }
  }
  for (const PackedTreeLeaf& leaf : leaves) add_node(leaf.box, leaf.offset, bytes);
  return bytes;
}

}  // namespace roadbed::map::gis
