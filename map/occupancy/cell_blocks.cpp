#include "roadbed/map/occupancy/cell_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::map {
namespace {

constexpr std::array<std::uint32_t, 3> kAxisBits{0b001001001, 0b010010010, 0b100100100};

// A zero bit, or two, after each bit of a number below 1024.
constexpr std::uint32_t spread(std::uint32_t value) {
  value = (value | value << 16) & 0x030000ffu;
  value = (value | value << 8) & 0x0300f00fu;
  value = (value | value << 4) & 0x030c30c3u;
  return (value | value << 2) & 0x09249249u;
}

std::uint32_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

std::uint32_t region_code(const CellKey& key) {
  return morton(key[0] >> 6, key[1] >> 6, key[2] >> 6);
}

std::uint32_t block_place(const CellKey& key) {
  return morton(key[0] >> 3 & 7u, key[1] >> 3 & 7u, key[2] >> 3 & 7u);
}

std::uint32_t cell_place(const CellKey& key) {
  return morton(key[0] & 7u, key[1] & 7u, key[2] & 7u);
}

void set_bit(CellBlock::Bits& bits, std::uint32_t cell) {
  bits[cell >> 6] |= std::uint64_t{1} << (cell & 63u);
}

std::uint64_t packed(const CellKey& key) {
  return std::uint64_t{key[2]} << 32 | std::uint64_t{key[1]} << 16 | key[0];
}

CellKey unpacked(std::uint64_t key) {
  return {static_cast<std::uint16_t>(key), static_cast<std::uint16_t>(key >> 16),
          static_cast<std::uint16_t>(key >> 32)};
}

}  // namespace

/// Moves a Morton code of three bits an axis by one along an axis, and says whether it came round.
struct CellBlocks::MortonStep {
  std::uint32_t bits = 0, addend = 0, round = 0;

  MortonStep() = default;
  MortonStep(unsigned axis, int sign)
      : bits(kAxisBits[axis]),
        addend(sign > 0 ? std::uint32_t{1} << axis : kAxisBits[axis]),
        round(sign > 0 ? 0u : kAxisBits[axis]) {}

  bool move(std::uint32_t& code) const {
    const std::uint32_t moved = ((code | ~bits) + addend) & bits;  // carries run over other axes
    code = (code & ~bits) | moved;
    return moved == round;
  }
};

/// Where a ray is: its cell, block and region.
struct CellBlocks::Cursor {
  std::uint64_t key = 0;
  std::uint32_t cell = 0, block = 0;
  BlockRegion* region = nullptr;
  CellBlock* at = nullptr;
  std::array<MortonStep, 3> steps;
  std::array<std::uint64_t, 3> key_steps{};

  void mark_free() const { set_bit(at->free, cell); }
};

void CellBlocks::begin_scan() {
  ++scan_;
  touched_.clear();
}

BlockRegion& CellBlocks::region_at(const CellKey& key) {
  const std::uint32_t code = region_code(key);
  if (last_region_ == nullptr || code != last_code_) {
    std::unique_ptr<BlockRegion>& region = regions_[code];
    if (!region) region = std::make_unique<BlockRegion>();
    last_region_ = region.get();
    last_code_ = code;
  }
  return *last_region_;
}

CellBlock& CellBlocks::block_in(BlockRegion& region, std::uint32_t place) {
  CellBlock*& block = region[place];
  if (block == nullptr) {
    if (block_count_ % kChunk == 0) chunks_.push_back(std::make_unique<CellBlock[]>(kChunk));
    block = &chunks_.back()[block_count_++ % kChunk];
  }
  if (block->scan != scan_) {
    block->scan = scan_;
    block->ends = {};
    touched_.push_back(block);
  }
  return *block;
}

CellBlock& CellBlocks::block_at(const CellKey& key) {
  return block_in(region_at(key), block_place(key));
}

bool CellBlocks::add_end(const CellKey& key) {
  CellBlock& block = block_at(key);
  const std::uint32_t cell = cell_place(key);
  const bool is_new = (block.ends[cell >> 6] >> (cell & 63u) & 1u) == 0;
  set_bit(block.ends, cell);
  return is_new;
}

void CellBlocks::mark_hit(const CellKey& key) { set_bit(block_at(key).hit, cell_place(key)); }

void CellBlocks::merge(const CellKey& first, const CellBlock::Bits& hit,
                       const CellBlock::Bits& free) {
  CellBlock& block = block_at(first);
  for (std::size_t word = 0; word < hit.size(); ++word) {
    block.hit[word] |= hit[word];
    block.free[word] |= free[word];
  }
}

void CellBlocks::set_out(Cursor& cursor, const CellKey& from) {
  cursor.key = packed(from);
  cursor.cell = cell_place(from);
  cursor.block = block_place(from);
  cursor.region = &region_at(from);
  cursor.at = &block_in(*cursor.region, cursor.block);
}

// The key is there already.
inline void CellBlocks::step(Cursor& cursor, unsigned axis) {
  if (!cursor.steps[axis].move(cursor.cell)) return;
  if (cursor.steps[axis].move(cursor.block)) cursor.region = &region_at(unpacked(cursor.key));
  cursor.at = &block_in(*cursor.region, cursor.block);
}

void CellBlocks::carve(const Eigen::Vector3f& origin, const CellKey& from,
                       const Eigen::Vector3f& end, const CellKey& to) {
  if (from == to) return;
  Cursor cursor;
  set_out(cursor, from);
  cursor.mark_free();

  const Eigen::Vector3f way = end - origin;
  const auto length_m = static_cast<float>(
      std::sqrt(static_cast<double>(way.x() * way.x() + way.y() * way.y() + way.z() * way.z())));
  std::array<double, 3> next_m{}, apart_m{};  // of the borders across each axis, along the ray
  for (unsigned axis = 0; axis < 3; ++axis) {
    const float direction = way[axis] / length_m;
    next_m[axis] = apart_m[axis] = std::numeric_limits<double>::max();
    if (!(direction > 0.0f) && !(direction < 0.0f)) continue;
    const int sign = direction > 0.0f ? 1 : -1;
    double border_m = (static_cast<double>(from[axis]) - kHalfRange + 0.5) * resolution_m_;
    border_m += static_cast<double>(static_cast<float>(sign * resolution_m_ * 0.5));
    next_m[axis] = (border_m - static_cast<double>(origin[axis])) / static_cast<double>(direction);
    apart_m[axis] = resolution_m_ / std::abs(static_cast<double>(direction));
    cursor.steps[axis] = MortonStep(axis, sign);
    const std::uint64_t one = std::uint64_t{1} << (16 * axis);
    cursor.key_steps[axis] = sign > 0 ? one : ~one + 1;
  }

  const std::uint64_t last = packed(to);
  double x_m = next_m[0], y_m = next_m[1], z_m = next_m[2];
  for (;;) {
    const bool x_first = x_m < y_m;
    const bool z_is_next = !((x_first ? x_m : y_m) < z_m);
    const unsigned axis = z_is_next ? 2u : x_first ? 0u : 1u;
    x_m = axis == 0 ? x_m + apart_m[0] : x_m;
    y_m = axis == 1 ? y_m + apart_m[1] : y_m;
    z_m = axis == 2 ? z_m + apart_m[2] : z_m;
    cursor.key += cursor.key_steps[axis];
    if (cursor.key == last) return;
    // Rounding may lead past the last cell.
    if (std::min(std::min(x_m, y_m), z_m) > static_cast<double>(length_m)) return;
    step(cursor, axis);
    cursor.mark_free();
  }
}

std::vector<CellBlocks::Placed> CellBlocks::regions() const {
  std::vector<Placed> placed;
  for (const auto& [code, region] : regions_) placed.push_back({code, region.get()});
  std::ranges::sort(placed, {}, &Placed::code);
  return placed;
}

}  // namespace roadbed::map
