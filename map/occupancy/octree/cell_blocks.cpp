#include "roadbed/map/occupancy/octree/cell_blocks.h"

#include <algorithm>
#include <array>

namespace roadbed::map::inline occupancy::inline octree {
namespace {

// `spread_bits` of what an axis of a cube may be.
constexpr std::array<std::uint8_t, 8> kSpread = [] {
  std::array<std::uint8_t, 8> spread{};
  for (std::uint32_t i = 0; i < 8; ++i) spread[i] = static_cast<std::uint8_t>(spread_bits(i));
  return spread;
}();

std::uint32_t region_code(const CellKey& key) {
  return morton(key[0] >> 6, key[1] >> 6, key[2] >> 6);
}

std::uint32_t place_in_cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return kSpread[x & 7u] | std::uint32_t{kSpread[y & 7u]} << 1 |
         std::uint32_t{kSpread[z & 7u]} << 2;
}

std::uint32_t block_place(const CellKey& key) {
  return place_in_cube(key[0] >> 3, key[1] >> 3, key[2] >> 3);
}

std::uint32_t cell_place(const CellKey& key) { return place_in_cube(key[0], key[1], key[2]); }

void set_bit(BlockBits& bits, std::uint32_t cell) {
  bits[cell >> 6] |= std::uint64_t{1} << (cell & 63u);
}

}  // namespace

void CellBlocks::begin_scan() {
  first_view_ = ++view_;
  touched_.clear();
}

BlockRegion& CellBlocks::region_at(const CellKey& key) {
  const std::uint32_t code = region_code(key);
  Near& near = near_[code % kNear];
  if (near.region == nullptr || near.code != code) {
    std::unique_ptr<BlockRegion>& region = regions_[code];
    if (!region) region = std::make_unique<BlockRegion>();
    near = {code, region.get()};
  }
  return *near.region;
}

CellBlock& CellBlocks::block_at(const CellKey& key) {
  CellBlock*& block = region_at(key)[block_place(key)];
  if (block == nullptr) {
    if (block_count_ % kChunk == 0) chunks_.push_back(std::make_unique<CellBlock[]>(kChunk));
    block = &chunks_.back()[block_count_++ % kChunk];
  }
  if (block->view != view_) {
    if (block->view < first_view_) touched_.push_back(block);
    block->view = view_;
    block->ends = {};
  }
  return *block;
}

// First all blocks, then their cells: the processor waits for many blocks at a time.
std::span<const CellBlocks::End> CellBlocks::add_ends(std::span<const CellKey> keys) {
  ends_.clear();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i > 0 && keys[i] == keys[i - 1]) continue;
    ends_.push_back({i, &block_at(keys[i]), cell_place(keys[i])});
  }
  std::erase_if(ends_, [](const End& end) {
    std::uint64_t& word = end.block->ends[end.cell >> 6];
    const std::uint64_t bit = std::uint64_t{1} << (end.cell & 63u);
    const bool is_known = (word & bit) != 0;
    word |= bit;
    return is_known;
  });
  return ends_;
}

void CellBlocks::mark_hit(const CellKey& key) { set_bit(block_at(key).hit, cell_place(key)); }

CellBlock& CellBlocks::merge(const CellKey& first, const BlockBits& hit, const BlockBits& free) {
  CellBlock& block = block_at(first);
  for (std::size_t word = 0; word < hit.size(); ++word) {
    block.hit[word] |= hit[word];
    block.free[word] |= free[word];
  }
  return block;
}

std::vector<CellBlocks::Placed> CellBlocks::regions() const {
  std::vector<Placed> placed;
  for (const auto& [code, region] : regions_) placed.push_back({code, region.get()});
  std::ranges::sort(placed, {}, &Placed::code);
  return placed;
}

}  // namespace roadbed::map::occupancy::octree
