#include "roadbed/map/occupancy/octree/compact_octree.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr std::size_t kMostNodes = std::numeric_limits<std::uint32_t>::max();
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

/// From the data of an `.ot` that of a `.bt`, node for node, and the values of its leaves: those
/// of one node's children stand together.
struct Judged {
  std::string bt;
  std::vector<std::uint32_t> first_leaf;  // of each inner node
  std::vector<float> log_odds;
};

class LogOddsJudge {
 public:
  explicit LogOddsJudge(std::string_view log_odds) : rest_(log_odds) {}

  Judged judged() {
    const Node root = node();
    if (root.pair != BtPair::inner) {  // a .bt cannot say so of the root, but of all its children
      judged_.bt.assign(kPairsBytes, '\0');
      put_pairs(judged_.bt, 0, root.pair == BtPair::free ? kAllFree : kAllOccupied);
      judged_.first_leaf.assign(1, 0);
      judged_.log_odds.assign(8, root.log_odds);
    }
    return std::move(judged_);
  }

 private:
  struct Node {
    BtPair pair;
    float log_odds;
  };

  Node node() {
    float value = 0.0f;
    std::memcpy(&value, rest_.data(), sizeof value);
    const auto there = static_cast<unsigned char>(rest_[sizeof value]);
    rest_.remove_prefix(kLogOddsBytes);
    if (there == 0) return {pair_of_log_odds(value), value};
    const std::size_t at = judged_.bt.size(), place = judged_.first_leaf.size();
    judged_.bt.append(kPairsBytes, '\0');
    judged_.first_leaf.push_back(0);
    unsigned pairs = 0, leaves = 0;
    std::array<float, 8> values{};
    for (unsigned child = 0; child < 8; ++child) {
      if ((there >> child & 1u) == 0) continue;
      const Node below = node();
      pairs |= static_cast<unsigned>(below.pair) << 2 * child;
      if (below.pair != BtPair::inner) values[leaves++] = below.log_odds;
    }
    put_pairs(judged_.bt, at, pairs);
    judged_.first_leaf[place] = static_cast<std::uint32_t>(judged_.log_odds.size());
    judged_.log_odds.insert(judged_.log_odds.end(), values.begin(), values.begin() + leaves);
    return {BtPair::inner, value};
  }

  std::string_view rest_;
  Judged judged_;
};

void append_log_odds(OctreeBytes& bytes, float value, unsigned children) {
  char node[kLogOddsBytes];
  std::memcpy(node, &value, sizeof value);
  node[sizeof value] = static_cast<char>(children);
  bytes.data.append(node, kLogOddsBytes);
  ++bytes.nodes;
}

}  // namespace

CompactOctree CompactOctree::read(Reading from) {
  const std::size_t nodes = from.data.size() / kPairsBytes;
  if (nodes > kMostNodes) throw std::length_error("over 2^32 inner nodes");
  CompactOctree tree;
  tree.pairs_.reserve(nodes);
  tree.first_inner_.reserve(nodes);
  tree.pairs_.resize(1);
  tree.first_inner_.resize(1);
  if (!from.first_leaf.empty()) tree.first_leaf_.resize(nodes);
  tree.read_node(from, 0);
  return tree;
}

CompactOctree CompactOctree::of_bt(std::string_view data) { return read({data}); }

CompactOctree CompactOctree::of_ot(std::string_view data) {
  if (data.size() / kLogOddsBytes > kMostNodes) throw std::length_error("over 2^32 nodes");
  Judged judged = LogOddsJudge(data).judged();
  CompactOctree tree = read({judged.bt, judged.first_leaf});
  tree.log_odds_ = std::move(judged.log_odds);
  return tree;
}

// Room for the children that are inner nodes comes first, so that they stand together.
void CompactOctree::read_node(Reading& from, std::size_t node) {
  const unsigned pairs = pairs_at(from.data);
  from.data.remove_prefix(kPairsBytes);
  if (!from.first_leaf.empty()) first_leaf_[node] = from.first_leaf[from.node++];
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
  for (; count > 0; --count) read_node(from, inner++);
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
  if (pairs_.empty()) return {};
  BtWriter writer;
  const BtPair root = write_bt(0, writer);
  return writer.take(root);
}

BtPair CompactOctree::write_bt(std::uint32_t node, BtWriter& writer) const {
  std::uint32_t inner = first_inner_[node];
  return writer.node([&](unsigned child) {
    const BtPair pair = pair_of(pairs_[node], child);
    return pair == BtPair::inner ? write_bt(inner++, writer) : pair;
  });
}

OctreeBytes CompactOctree::ot() const {
  OctreeBytes bytes;
  if (!pairs_.empty()) write_ot(0, bytes);
  return bytes;
}

// An inner node has the greatest value below it, which is returned.
float CompactOctree::write_ot(std::uint32_t node, OctreeBytes& bytes) const {
  const std::size_t at = bytes.data.size();
  unsigned there = 0;
  for (unsigned child = 0; child < 8; ++child) {
    there |= unsigned{pair_of(pairs_[node], child) != BtPair::unknown} << child;
  }
  append_log_odds(bytes, 0.0f, there);
  std::uint32_t inner = first_inner_[node], leaf = first_leaf(node);
  float most = -std::numeric_limits<float>::infinity();
  for (unsigned child = 0; child < 8; ++child) {
    const BtPair pair = pair_of(pairs_[node], child);
    if (pair == BtPair::unknown) continue;
    float value = 0.0f;
    if (pair == BtPair::inner) {
      value = write_ot(inner++, bytes);
    } else {
      value = log_odds_of(pair, leaf++);
      append_log_odds(bytes, value, 0);
    }
    most = std::max(most, value);
  }
  std::memcpy(&bytes.data[at], &most, sizeof most);
  return most;
}

}  // namespace roadbed::map::occupancy::octree
