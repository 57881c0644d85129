#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace roadbed::map {

/// Key of a cell at the finest level: 16 bits an axis, as in OctoMap.
using CellKey = std::array<std::uint16_t, 3>;

/// Cells on either side of the origin.
inline constexpr double kHalfRange = 32768.0;

/// A cube of 8×8×8 cells: what was measured at each, a bit a cell. Cells are in Morton order, x
/// lowest, so that a byte is a cube of 2×2×2 cells and a word one of 4×4×4: the nodes of an octree.
struct CellBlock {
  using Bits = std::array<std::uint64_t, 8>;
  Bits hit{}, free{};
  Bits ends{};             ///< cells that a point of the current scan lies in
  std::uint32_t scan = 0;  ///< the last one that came here

  /// With `sticky` off: the log-odds of each cell, NaN where nothing was measured.
  std::unique_ptr<std::array<float, 512>> log_odds;
};

/// A cube of 8×8×8 blocks in Morton order; null where nothing was measured.
using BlockRegion = std::array<CellBlock*, 512>;

/// What rays measured, cell by cell, in hashed regions of blocks. A ray finds its next block beside
/// the last one, without the hash. 208 bytes a block, 4 kB a region.
class CellBlocks {
 public:
  explicit CellBlocks(double resolution_m) : resolution_m_(resolution_m) {}

  /// What follows is one scan: of several points in a cell only the first is new.
  void begin_scan();

  /// Marks that a point of the scan lies in the cell, and says whether it is the first.
  bool add_end(const CellKey& key);

  void mark_hit(const CellKey& key);

  /// Adds what was measured elsewhere to a block. @param first  key of its first cell.
  void merge(const CellKey& first, const CellBlock::Bits& hit, const CellBlock::Bits& free);

  /// Marks as free what a ray crosses from its origin's cell on, without the cell that it ends in;
  /// nothing if that is the same. The cells are those of OctoMap's computeRayKeys, whose arithmetic
  /// in float and double it repeats [Amanatides & Woo 1987].
  /// @param from, to  keys of both ends.
  void carve(const Eigen::Vector3f& origin, const CellKey& from, const Eigen::Vector3f& end,
             const CellKey& to);

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
  struct MortonStep;
  struct Cursor;

  BlockRegion& region_at(const CellKey& key);
  CellBlock& block_in(BlockRegion& region, std::uint32_t place);
  CellBlock& block_at(const CellKey& key);
  void set_out(Cursor& cursor, const CellKey& from);
  void step(Cursor& cursor, unsigned axis);

  double resolution_m_;
  std::unordered_map<std::uint32_t, std::unique_ptr<BlockRegion>> regions_;
  std::vector<std::unique_ptr<CellBlock[]>> chunks_;
  std::size_t block_count_ = 0;
  std::uint32_t scan_ = 0;
  std::vector<CellBlock*> touched_;
  BlockRegion* last_region_ = nullptr;
  std::uint32_t last_code_ = 0;
};

}  // namespace roadbed::map
