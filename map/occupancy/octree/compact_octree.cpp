#include "roadbed/map/occupancy/octree/compact_octree.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr std::size_t kPairsBytes = 2;
constexpr std::size_t kLogOddsBytes = sizeof(float) + 1;

unsigned pairs_at(std::string_view data) {
  return static_cast<unsigned char>(data[0]) |
         static_cast<unsigned>(static_cast<unsigned char>(data[1])) << 8;
}

void put_pairs(std::string& data, std::size_t at, unsigned pairs) {
  data[at] = static_cast<char>(pairs & 0xffu);
  data[at + 1] = static_cast<char>(pairs >> 8);
}

// From the data of an `.ot` that of a `.bt`, node for node.
class LogOddsJudge {
 public:
  explicit LogOddsJudge(std::string_view log_odds) : rest_(log_odds) {}

  std::string judged() {
    const BtPair root = node();
    if (root != BtPair::inner) {  // a .bt cannot say so of the root, but of all of its children
      bt_.assign(kPairsBytes, '\0');
      put_pairs(bt_, 0, root == BtPair::free ? kAllFree : kAllOccupied);
    }
    return std::move(bt_);
  }

 private:
  BtPair node() {
    float value = 0.0f;
    std::memcpy(&value, rest_.data(), sizeof value);
    const auto there = static_cast<unsigned char>(rest_[sizeof value]);
    rest_.remove_prefix(kLogOddsBytes);
    if (there == 0) return value >= 0.0f ? BtPair::occupied : BtPair::free;
    const std::size_t at = bt_.size();
    bt_.append(kPairsBytes, '\0');
    unsigned pairs = 0;
    for (unsigned child = 0; child < 8; ++child) {
      if ((there >> child & 1u) != 0) pairs |= static_cast<unsigned>(node()) << 2 * child;
    }
    put_pairs(bt_, at, pairs);
    return BtPair::inner;
  }

  std::string_view rest_;
  std::string bt_;
};

void append_log_odds(OctreeBytes& bytes, float value, unsigned children) {
  char node[kLogOddsBytes];
  std::memcpy(node, &value, sizeof value);
  node[sizeof value] = static_cast<char>(children);
  bytes.data.append(node, kLogOddsBytes);
  ++bytes.nodes;
}

}  // namespace

CompactOctree CompactOctree::of_bt(std::string_view data) {
  constexpr std::size_t kMostNodes = std::numeric_limits<std::uint32_t>::max();
  if (data.size() / kPairsBytes > kMostNodes) throw std::length_error("over 2^32 inner nodes");
  CompactOctree tree;
  tree.pairs_.reserve(data.size() / kPairsBytes);
  tree.first_inner_.reserve(data.size() / kPairsBytes);
  tree.pairs_.resize(1);
  tree.first_inner_.resize(1);
  tree.read_node(data, 0);
  return tree;
}

CompactOctree CompactOctree::of_ot(std::string_view data) {
  return of_bt(LogOddsJudge(data).judged());
}

// Room for the children that are inner nodes comes first, so that they stand together.
void CompactOctree::read_node(std::string_view& data, std::size_t node) {
  const unsigned pairs = pairs_at(data);
  data.remove_prefix(kPairsBytes);
  std::size_t inner = pairs_.size(), count = 0;
  for (unsigned child = 0; child < 8; ++child) {
    const BtPair pair = pair_of(pairs, child);
    count += pair == BtPair::inner;
    leaves_ += pair == BtPair::free || pair == BtPair::occupied;
  }
  pairs_[node] = static_cast<std::uint16_t>(pairs);
  first_inner_[node] = static_cast<std::uint32_t>(inner);
  pairs_.resize(inner + count);
  first_inner_.resize(inner + count);
  for (; count > 0; --count) read_node(data, inner++);
}

CellState CompactOctree::at(const CellKey& key) const {
  if (pairs_.empty()) return CellState::unknown;
  std::uint32_t node = 0;
  for (int bit = 15; bit >= 0; --bit) {
    const auto of_axis = [&](std::size_t axis) { return (key[axis] >> bit & 1u) << axis; };
    const unsigned child = of_axis(0) | of_axis(1) | of_axis(2);
    switch (pair_of(pairs_[node], child)) {
      case BtPair::unknown:
        return CellState::unknown;
      case BtPair::free:
        return CellState::free;
      case BtPair::occupied:
        return CellState::occupied;
      case BtPair::inner:
        break;
    }
    std::uint32_t below = first_inner_[node];
    for (unsigned before = 0; before < child; ++before) {
      below += pair_of(pairs_[node], before) == BtPair::inner;
    }
    node = below;
  }
  return CellState::unknown;  // not reached: what lies 16 levels deep is a leaf
}

OctreeBytes CompactOctree::bt() const {
  OctreeBytes bytes;
  if (pairs_.empty()) return bytes;
  const BtPair root = write_bt(0, bytes);
  if (root != BtPair::inner) {
    bytes.data.resize(kPairsBytes);
    put_pairs(bytes.data, 0, root == BtPair::free ? kAllFree : kAllOccupied);
    bytes.nodes = 8;
  }
  ++bytes.nodes;  // the root
  return bytes;
}

BtPair CompactOctree::write_bt(std::uint32_t node, OctreeBytes& bytes) const {
  const std::size_t at = bytes.data.size();
  bytes.data.append(kPairsBytes, '\0');
  std::uint32_t inner = first_inner_[node];
  unsigned pairs = 0;
  for (unsigned child = 0; child < 8; ++child) {
    BtPair pair = pair_of(pairs_[node], child);
    if (pair == BtPair::inner) pair = write_bt(inner++, bytes);
    pairs |= static_cast<unsigned>(pair) << 2 * child;
  }
  if (pairs == kAllFree || pairs == kAllOccupied) {
    bytes.data.resize(at);
    return pair_of(pairs, 0);
  }
  put_pairs(bytes.data, at, pairs);
  for (unsigned child = 0; child < 8; ++child) {
    bytes.nodes += pair_of(pairs, child) != BtPair::unknown;
  }
  return BtPair::inner;
}

OctreeBytes CompactOctree::ot() const {
  OctreeBytes bytes;
  if (!pairs_.empty()) write_ot(0, LogOddsRule::of_octomap(), bytes);
  return bytes;
}

// An inner node has the greatest value below it, which is returned.
float CompactOctree::write_ot(std::uint32_t node, const LogOddsRule& rule,
                              OctreeBytes& bytes) const {
  const std::size_t at = bytes.data.size();
  unsigned there = 0;
  for (unsigned child = 0; child < 8; ++child) {
    there |= unsigned{pair_of(pairs_[node], child) != BtPair::unknown} << child;
  }
  append_log_odds(bytes, 0.0f, there);
  std::uint32_t inner = first_inner_[node];
  float most = -std::numeric_limits<float>::infinity();
  for (unsigned child = 0; child < 8; ++child) {
    const BtPair pair = pair_of(pairs_[node], child);
    if (pair == BtPair::unknown) continue;
    float value = 0.0f;
    if (pair == BtPair::inner) {
      value = write_ot(inner++, rule, bytes);
    } else {
      value = pair == BtPair::free ? rule.least : rule.most;
      append_log_odds(bytes, value, 0);
    }
    most = std::max(most, value);
  }
  std::memcpy(&bytes.data[at], &most, sizeof most);
  return most;
}

}  // namespace roadbed::map::occupancy::octree
