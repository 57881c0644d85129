#include "roadbed/map/gis/packed_tree.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace roadbed::map::inline gis {
namespace {

using Nodes = std::vector<PackedTreeLeaf>;

/// The level above: `first` is the number of the level's first node in the whole tree.
Nodes parents_of(const Nodes& level, std::uint64_t first) {
  Nodes parents;
  for (std::size_t i = 0; i < level.size(); i += kPackedTreeNode) {
    PackedTreeLeaf parent{{}, first + i};
    const std::size_t end = std::min(level.size(), i + kPackedTreeNode);
    for (std::size_t k = i; k < end; ++k) parent.box.extend(level[k].box);
    parents.push_back(parent);
  }
  return parents;
}

/// How many nodes are before each level, leaves first; a tree ends with one root.
std::vector<std::uint64_t> firsts_of_levels(std::size_t leaves) {
  std::vector<std::uint64_t> counts{leaves};
  do counts.push_back((counts.back() + kPackedTreeNode - 1) / kPackedTreeNode);
  while (counts.back() > 1);
  std::uint64_t before = 0;
  for (std::size_t i = counts.size(); i-- > 0;) {
    const std::uint64_t count = counts[i];
    counts[i] = before;
    before += count;
  }
  return counts;
}

template <typename T>
void add_raw(T value, std::string& bytes) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void add(const Nodes& level, std::string& bytes) {
  for (const PackedTreeLeaf& node : level) {
    for (const double side :
         {node.box.min().x(), node.box.min().y(), node.box.max().x(), node.box.max().y()}) {
      add_raw(side, bytes);
    }
    add_raw(node.offset, bytes);
  }
}

}  // namespace

std::string packed_tree(std::span<const PackedTreeLeaf> leaves) {
  if (leaves.empty()) return {};
  const std::vector<std::uint64_t> firsts = firsts_of_levels(leaves.size());
  std::vector<Nodes> levels{Nodes(leaves.begin(), leaves.end())};
  for (std::size_t i = 0; i + 1 < firsts.size(); ++i) {
    levels.push_back(parents_of(levels.back(), firsts[i]));
  }
  std::string bytes;
  std::for_each(levels.rbegin(), levels.rend(), [&](const Nodes& level) { add(level, bytes); });
  return bytes;
}

}  // namespace roadbed::map::gis
