#pragma once

// Private to map/occupancy.

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace roadbed::map {

/// Key of a cell at the finest level: 16 bits an axis, as in OctoMap.
using CellKey = std::array<std::uint16_t, 3>;

/// A set of cells as bits in hashed blocks of 8×8×8. Rays enter the same block many times in a row,
/// so the last one is kept at hand. About 100 bytes a block.
class CellSet {
 public:
  /// Adds a cell and says whether it is new.
  bool insert(const CellKey& key) {
    std::uint64_t& word = block_of(key)[key[2] & 7u];
    const std::uint64_t bit = std::uint64_t{1} << ((key[1] & 7u) * 8 + (key[0] & 7u));
    const bool is_new = (word & bit) == 0;
    word |= bit;
    return is_new;
  }

  std::size_t block_count() const { return blocks_.size(); }

  /// Calls `visit(key)` for every cell, block by block in ascending order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    std::vector<std::uint64_t> ids;
    ids.reserve(blocks_.size());
    for (const auto& entry : blocks_) ids.push_back(entry.first);
    std::sort(ids.begin(), ids.end());
    for (const std::uint64_t id : ids) visit_block(id, blocks_.at(id), visit);
  }

 private:
  using Block = std::array<std::uint64_t, 8>;  // a word per z, a bit per x and y

  static std::uint64_t id_of(const CellKey& key) {
    return std::uint64_t{key[2]} >> 3 << 26 | std::uint64_t{key[1]} >> 3 << 13 |
           std::uint64_t{key[0]} >> 3;
  }

  Block& block_of(const CellKey& key) {
    const std::uint64_t id = id_of(key);
    if (last_ == nullptr || id != last_id_) {
      last_ = &blocks_[id];  // addresses in a map stay as it grows
      last_id_ = id;
    }
    return *last_;
  }

  template <typename Visit>
  static void visit_block(std::uint64_t id, const Block& block, const Visit& visit) {
    const auto base = [id](int shift) {
      return static_cast<unsigned>((id >> shift & 0x1fffu) << 3);
    };
    for (unsigned z = 0; z < 8; ++z) {
      for (unsigned bit = 0; bit < 64; ++bit) {
        if ((block[z] >> bit & 1u) == 0) continue;
        visit(CellKey{static_cast<std::uint16_t>(base(0) + (bit & 7u)),
                      static_cast<std::uint16_t>(base(13) + (bit >> 3)),
                      static_cast<std::uint16_t>(base(26) + z)});
      }
    }
  }

  std::unordered_map<std::uint64_t, Block> blocks_;
  Block* last_ = nullptr;
  std::uint64_t last_id_ = 0;
};

}  // namespace roadbed::map
