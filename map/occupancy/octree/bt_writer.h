#pragma once

// Private to map/occupancy.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "roadbed/map/occupancy/octree/cell_blocks.h"
#include "roadbed/map/occupancy/octree/octree_data.h"

namespace roadbed::map::inline occupancy::inline octree {

/// What two bits of a `.bt` say of a child. Eight of them, the first lowest, are an inner node.
enum class BtPair : unsigned { unknown = 0, free = 1, occupied = 2, inner = 3 };

constexpr BtPair pair_of(unsigned pairs, unsigned child) {
  return static_cast<BtPair>(pairs >> 2 * child & 3u);
}

inline constexpr unsigned kAllFree = 0x5555, kAllOccupied = 0xaaaa;

/// Of log-odds; NaN where nothing was measured. 0 and above is occupied, OctoMap's threshold.
inline BtPair pair_of_log_odds(float value) {
  if (std::isnan(value)) return BtPair::unknown;
  return value >= 0.0f ? BtPair::occupied : BtPair::free;
}

/// Writes the data of a `.bt`, a node before its children: eight equal leaves become one, and what
/// has no child is not there. What is written is taken back then.
class BtWriter {
 public:
  using Node = BtPair;

  static Node none() { return BtPair::unknown; }

  /// Two bytes say which children there are; the children's own follow.
  /// @param child  writes one by its number, and returns what it wrote.
  template <typename Child>
  Node node(const Child& child) {
    const std::size_t at = open();
    unsigned pairs = 0;
    for (unsigned i = 0; i < 8; ++i) pairs |= static_cast<unsigned>(child(i)) << 2 * i;
    return close(at, pairs);
  }

  /// @param value  log-odds, as of `pair_of_log_odds`.
  static Node leaf(float value) { return pair_of_log_odds(value); }

  /// A cube of 8×8×8 cells in Morton order.
  Node block(const std::array<float, 512>& values) {
    BlockBits hit{}, free{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const BtPair pair = pair_of_log_odds(values[i]);
      hit[i >> 6] |= std::uint64_t{pair == BtPair::occupied} << (i & 63u);
      free[i >> 6] |= std::uint64_t{pair == BtPair::free} << (i & 63u);
    }
    return block(hit, free);
  }
  Node block(const CellBlock& block) { return this->block(block.hit, block.free); }

  /// @param root  what was written; a `.bt` cannot say of it that it is a leaf, but of its
  /// children.
  OctreeBytes take(Node root) {
    if (root == BtPair::free || root == BtPair::occupied) {
      put(open(), root == BtPair::free ? kAllFree : kAllOccupied);
    }
    bytes_.nodes += !bytes_.data.empty();  // the root
    return std::move(bytes_);
  }

 private:
  Node block(const BlockBits& hit, const BlockBits& free) {
    return node([&](unsigned i) { return word(hit[i], free[i] & ~hit[i]); });
  }

  Node word(std::uint64_t hit, std::uint64_t free) {
    if ((hit | free) == 0) return BtPair::unknown;
    if (hit == ~std::uint64_t{0}) return BtPair::occupied;
    if (free == ~std::uint64_t{0}) return BtPair::free;
    return node([&](unsigned i) { return leaves(hit >> 8 * i & 0xffu, free >> 8 * i & 0xffu); });
  }

  Node leaves(std::uint64_t hit, std::uint64_t free) {
    return close(open(), kApart[free] | static_cast<unsigned>(kApart[hit]) << 1);
  }

  std::size_t open() {
    bytes_.data.append(2, '\0');
    return bytes_.data.size() - 2;
  }

  Node close(std::size_t at, unsigned pairs) {
    if (pairs == 0 || pairs == kAllFree || pairs == kAllOccupied) {
      bytes_.data.resize(at);
      return pair_of(pairs, 0);
    }
    put(at, pairs);
    return BtPair::inner;
  }

  void put(std::size_t at, unsigned pairs) {
    bytes_.data[at] = static_cast<char>(pairs & 0xffu);
    bytes_.data[at + 1] = static_cast<char>(pairs >> 8);
    for (; pairs != 0; pairs >>= 2) bytes_.nodes += (pairs & 3u) != 0;
  }

  // The bits of a byte, each followed by a zero.
  static constexpr std::array<std::uint16_t, 256> kApart = [] {
    std::array<std::uint16_t, 256> apart{};
    for (unsigned byte = 0; byte < 256; ++byte) {
      for (unsigned bit = 0; bit < 8; ++bit) {
        apart[byte] = static_cast<std::uint16_t>(apart[byte] | (byte >> bit & 1u) << 2 * bit);
      }
    }
    return apart;
  }();

  OctreeBytes bytes_;
};

}  // namespace roadbed::map::occupancy::octree
