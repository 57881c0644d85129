#pragma once

// Private to map/occupancy.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_key.h"

namespace roadbed::map::inline occupancy::inline octree {

/// A cube of 8×8×8 cells: what was measured at each, a bit a cell.
struct CellBlock {
  BlockBits hit{}, free{};
  BlockBits ends{};        ///< cells that a point of the current view lies in
  std::uint32_t view = 0;  ///< the last one that came here

  /// With `sticky` off: the log-odds of each cell, NaN where nothing was measured.
  std::unique_ptr<std::array<float, 512>> log_odds;
};

/// A cube of 8×8×8 blocks in Morton order; null where nothing was measured.
using BlockRegion = std::array<CellBlock*, 512>;

/// What was measured, cell by cell, in hashed regions of blocks. 208 bytes a block, 4 kB a region.
class CellBlocks {
 public:
  CellBlocks() : near_(kNear) {}

  /// What follows is one scan: of several points in a cell only the first is new.
  void begin_scan();

  /// The same scan goes on from elsewhere: points are new again, `touched` stays.
  void begin_view() { ++view_; }

  struct End {
    std::size_t index;  ///< of its key
    CellBlock* block;
    std::uint32_t cell;  ///< its place in the block
    void mark_hit() const { block->hit[cell >> 6] |= std::uint64_t{1} << (cell & 63u); }
  };
  /// Marks that points of the scan lie in cells, and says which of these cells are new. Valid until
  /// the next call.
  std::span<const End> add_ends(std::span<const CellKey> keys);

  void mark_hit(const CellKey& key);

  /// Adds what was measured elsewhere to a block, which is returned.
  /// @param first  key of its first cell.
  CellBlock& merge(const CellKey& first, const BlockBits& hit, const BlockBits& free);

  /// What blocks and regions take of memory [bytes], without log-odds.
  std::size_t kept_bytes() const {
    return block_count_ * sizeof(CellBlock) + regions_.size() * sizeof(BlockRegion);
  }

  std::size_t block_count() const { return block_count_; }

  /// Blocks that the current scan came to, in the order of its coming.
  const std::vector<CellBlock*>& touched() const { return touched_; }

  struct Placed {
    std::uint32_t code;  ///< Morton code of the region's place, 10 bits an axis
    const BlockRegion* region;
  };
  /// All regions by their code.
  std::vector<Placed> regions() const;

  /// Calls `visit(block)` for each, in no order that may be relied on.
  template <typename Visit>
  void for_each(const Visit& visit) {
    for (std::size_t i = 0; i < block_count_; ++i) visit(chunks_[i / kChunk][i % kChunk]);
  }

 private:
  static constexpr std::size_t kChunk = 1024;
  static constexpr std::size_t kNear = 4096;  // regions that are found without the hash
  struct Near {
    std::uint32_t code = 0;
    BlockRegion* region = nullptr;
  };

  BlockRegion& region_at(const CellKey& key);
  CellBlock& block_at(const CellKey& key);

  std::unordered_map<std::uint32_t, std::unique_ptr<BlockRegion>> regions_;
  std::vector<Near> near_;  // by the lower bits of their codes
  std::vector<std::unique_ptr<CellBlock[]>> chunks_;
  std::size_t block_count_ = 0;
  std::uint32_t view_ = 0, first_view_ = 0;  // now, and of the scan
  std::vector<CellBlock*> touched_;
  std::vector<End> ends_;
};

}  // namespace roadbed::map::occupancy::octree
