#pragma once

// Private to map/occupancy.

#include <array>
#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_blocks.h"
#include "roadbed/map/occupancy/octree/occupancy_options.h"

namespace roadbed::map::inline occupancy::inline octree {

/// How measurements change the log-odds of a cell that is not sticky; OctoMap's own numbers.
struct LogOddsRule {
  float hit = 0.0f, miss = 0.0f;    ///< are added
  float least = 0.0f, most = 0.0f;  ///< and the sum is kept between these
  float occupied_from = 0.0f;

  static LogOddsRule of_octomap();
};

/// A number at each of 512 cells, up to 255: a plane for each of its bits, so that 64 cells are
/// counted at once.
class BlockCounts {
 public:
  static constexpr unsigned kMost = 255;

  /// Adds one at some cells. Returns the bytes of memory that this took.
  std::size_t add(const BlockBits& cells);

  BlockBits more_than(const BlockCounts& other) const;
  BlockBits more_than(unsigned count) const;

 private:
  template <typename Other>
  BlockBits above(const Other& bits_of_plane) const;

  std::vector<BlockBits> planes_;  // from the lowest bit on
};

/// Accumulates scans, where cells are more than the hits and free cells of all: log-odds, or counts
/// for the see-through filter, which takes away hits that enough clouds saw through.
class ScanAccumulator {
 public:
  /// Hits and free cells stay in their blocks.
  ScanAccumulator() = default;

  /// As the options say: nothing, log-odds, or what was seen through.
  explicit ScanAccumulator(const OccupancyOptions& options);

  /// Whether each scan has to be taken before the next one begins, or each cloud, of many scans.
  bool takes_scans() const { return has_log_odds_; }
  bool takes_clouds() const { return seen_through_ > 0; }

  /// Adds what was measured in a block, and takes its bits away.
  void take(CellBlock& block);

  /// Gives all blocks the bits of what their cells are now.
  void settle(CellBlocks& blocks);

  /// What it takes of memory for so many blocks, besides these.
  std::size_t kept_bytes(std::size_t blocks) const;

  /// Cells that were hit and count as free, since clouds saw through them.
  std::size_t removed() const { return removed_; }

 private:
  struct Looks {
    BlockBits hit{}, free{};  // of all clouds
    BlockCounts hits, through;
  };

  void weigh(CellBlock& block) const;
  void count_looks(CellBlock& block);
  void settle_by_log_odds(CellBlock& block) const;
  void settle_by_looks(CellBlock& block, const Looks& looks);

  LogOddsRule rule_ = {};
  bool has_log_odds_ = false;
  unsigned seen_through_ = 0;
  std::unordered_map<CellBlock*, Looks> looks_;
  std::size_t looks_bytes_ = 0, removed_ = 0;
};

}  // namespace roadbed::map::occupancy::octree
