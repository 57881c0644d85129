#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_key.h"

namespace roadbed::map::inline occupancy::inline octree {

/// The cells that the rays of one scan cross: a bit a cell, in hashed pages of 32×32×32 cells in
/// Morton order, so that a ray finds the next cell by a few operations on bits, and seldom leaves
/// its page. Pages are used again for the next scan. 4 kB a page.
class FreeSpaceRays {
 public:
  explicit FreeSpaceRays(double resolution_m);

  /// Marks what a ray crosses from its origin's cell on, without the cell that it ends in; nothing
  /// if that is the same. The cells are those of OctoMap's computeRayKeys, whose arithmetic in
  /// float and double it repeats [Amanatides & Woo 1987].
  /// @param from, to  keys of both ends.
  void carve(const Eigen::Vector3f& origin, const CellKey& from, const Eigen::Vector3f& end,
             const CellKey& to);

  /// What pages take of memory [bytes].
  std::size_t kept_bytes() const { return chunks_.size() * kChunk * sizeof(Page); }

  /// Of these what the pages of rays take that were not yet drained [bytes].
  std::size_t used_bytes() const { return codes_.size() * sizeof(Page); }

  /// Calls `visit(first, bits)` for each block that a ray crossed, with the key of its first cell,
  /// and forgets them all.
  template <typename Visit>
  void drain(const Visit& visit) {
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      for (std::uint32_t block = 0; block < kBlocks; ++block) {
        BlockBits& bits = page_at(i).blocks[block];
        if (std::ranges::all_of(bits, [](std::uint64_t word) { return word == 0; })) continue;
        visit(first_cell(codes_[i], block), bits);
        bits = {};
      }
    }
    forget();
  }

 private:
  static constexpr std::size_t kChunk = 64;   // pages that are allocated together
  static constexpr std::size_t kBlocks = 64;  // of a page
  struct alignas(64) Page {
    std::array<BlockBits, kBlocks> blocks{};
  };
  /// Of a table with open addressing.
  struct Slot {
    std::uint64_t code = kNoPage;
    Page* page = nullptr;
  };
  static constexpr std::uint64_t kNoPage = ~std::uint64_t{0};
  struct Ray;

  static CellKey first_cell(std::uint64_t code, std::uint32_t block);

  Page& page_at(std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  Slot& slot_of(std::uint64_t code);
  Page& page_of(std::uint64_t code);
  Page& add_page(std::uint64_t code);
  void forget();
  void mark(const CellKey& key);
  void walk(const Ray& ray, const CellKey& from, std::uint32_t steps);
  void walk_warily(Ray ray, CellKey key, const CellKey& to);

  double resolution_m_;
  std::vector<std::unique_ptr<Page[]>> chunks_;
  std::vector<std::uint64_t> codes_;  // of the pages in use
  std::vector<Slot> slots_;
};

}  // namespace roadbed::map::occupancy::octree
