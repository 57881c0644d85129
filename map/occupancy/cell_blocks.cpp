#include "roadbed/map/occupancy/cell_blocks.h"

#include <algorithm>

#include "roadbed/map/occupancy/morton.h"

namespace roadbed::map {
namespace {

std::uint32_t region_code(const CellKey& key) {
  return morton(key[0] >> 6, key[1] >> 6, key[2] >> 6);
}

std::uint32_t block_place(const CellKey& key) {
  return morton(key[0] >> 3 & 7u, key[1] >> 3 & 7u, key[2] >> 3 & 7u);
}

std::uint32_t cell_place(const CellKey& key) {
  return morton(key[0] & 7u, key[1] & 7u, key[2] & 7u);
}

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

bool CellBlocks::add_end(const CellKey& key) {
  CellBlock& block = block_at(key);
  const std::uint32_t cell = cell_place(key);
  const bool is_new = (block.ends[cell >> 6] >> (cell & 63u) & 1u) == 0;
  set_bit(block.ends, cell);
  return is_new;
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

}  // namespace roadbed::map
