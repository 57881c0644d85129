#pragma once

// Private to map/occupancy.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include "roadbed/map/occupancy/octree/cell_blocks.h"
#include "roadbed/map/occupancy/octree/octree_data.h"

namespace roadbed::map::inline occupancy::inline octree {

/// Writes the data of an `.ot`, a node before its children: eight equal leaves become one, and what
/// has no child is not there.
class OtWriter {
 public:
  /// A node that was written; `value` is NaN where there is none.
  struct Node {
    float value;
    bool is_leaf;
  };

  static Node none() { return {std::numeric_limits<float>::quiet_NaN(), true}; }

  /// @param child  writes one by its number, and returns what it wrote.
  template <typename Child>
  Node node(const Child& child) {
    const std::size_t at = bytes_.data.size(), nodes = bytes_.nodes;
    bytes_.data.append(kNodeBytes, '\0');
    ++bytes_.nodes;
    unsigned there = 0, leaves = 0;
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (unsigned i = 0; i < 8; ++i) {
      const Node made = child(i);
      if (std::isnan(made.value)) continue;
      there |= 1u << i;
      leaves += made.is_leaf;
      least = std::min(least, made.value);
      most = std::max(most, made.value);
    }
    const bool is_one = leaves == 8 && least == most;
    if (there == 0 || is_one) {
      bytes_.data.resize(at);
      bytes_.nodes = nodes;
      return is_one ? leaf(most) : none();
    }
    std::memcpy(&bytes_.data[at], &most, sizeof most);
    bytes_.data[at + sizeof most] = static_cast<char>(there);
    return {most, false};
  }

  Node leaf(float value) {
    if (std::isnan(value)) return none();
    char bytes[kNodeBytes] = {};
    std::memcpy(bytes, &value, sizeof value);
    bytes_.data.append(bytes, kNodeBytes);
    ++bytes_.nodes;
    return {value, true};
  }

  /// A cube of 8×8×8 cells in Morton order.
  Node block(const std::array<float, 512>& values) { return cells(values, 0, values.size()); }
  Node block(const CellBlock& block) { return this->block(*block.log_odds); }

  OctreeBytes take(Node) { return std::move(bytes_); }

 private:
  static constexpr std::size_t kNodeBytes = sizeof(float) + 1;

  Node cells(const std::array<float, 512>& values, std::size_t from, std::size_t count) {
    if (count == 1) return leaf(values[from]);
    const std::size_t part = count / 8;
    return node([&](std::size_t i) { return cells(values, from + i * part, part); });
  }

  OctreeBytes bytes_;
};

}  // namespace roadbed::map::occupancy::octree
