#include "roadbed/map/occupancy/octree/scan_accumulator.h"

#include <octomap/octomap.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace roadbed::map::inline occupancy::inline octree {
namespace {

template <typename Visit>
void for_each_bit(std::uint64_t word, const Visit& visit) {
  for (; word != 0; word &= word - 1) visit(static_cast<std::size_t>(std::countr_zero(word)));
}

BlockBits bits_where(const std::array<float, 512>& values, bool (*holds)(float, float),
                     float than) {
  BlockBits bits{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (holds(values[i], than)) bits[i / 64] |= std::uint64_t{1} << i % 64;
  }
  return bits;
}

}  // namespace

std::size_t BlockCounts::add(const BlockBits& cells) {
  const std::size_t planes = planes_.size();
  const BlockBits below = [&] {
    BlockBits full = more_than(kMost - 1);
    for (std::uint64_t& word : full) word = ~word;
    return full;
  }();
  for (std::size_t word = 0; word < cells.size(); ++word) {
    std::uint64_t carry = cells[word] & below[word];
    for (std::size_t plane = 0; carry != 0; ++plane) {
      if (plane == planes_.size()) planes_.emplace_back();
      const std::uint64_t next = planes_[plane][word] & carry;
      planes_[plane][word] ^= carry;
      carry = next;
    }
  }
  return (planes_.size() - planes) * sizeof(BlockBits);
}

// From the highest plane down: the first bit that differs decides.
template <typename Other>
BlockBits BlockCounts::above(const Other& bits_of_plane) const {
  BlockBits more{}, equal;
  equal.fill(~std::uint64_t{0});
  for (auto plane = static_cast<std::size_t>(std::bit_width(kMost)); plane-- > 0;) {
    for (std::size_t word = 0; word < equal.size(); ++word) {
      const std::uint64_t ours = plane < planes_.size() ? planes_[plane][word] : 0;
      const std::uint64_t theirs = bits_of_plane(plane, word);
      more[word] |= equal[word] & ours & ~theirs;
      equal[word] &= ~(ours ^ theirs);
    }
  }
  return more;
}

BlockBits BlockCounts::more_than(const BlockCounts& other) const {
  return above([&](std::size_t plane, std::size_t word) {
    return plane < other.planes_.size() ? other.planes_[plane][word] : 0;
  });
}

BlockBits BlockCounts::more_than(unsigned count) const {
  return above([&](std::size_t plane, std::size_t) {
    return (count >> plane & 1u) != 0 ? ~std::uint64_t{0} : std::uint64_t{0};
  });
}

LogOddsRule LogOddsRule::of_octomap() {
  const octomap::OcTree usual(1.0);
  return {.hit = usual.getProbHitLog(),
          .miss = usual.getProbMissLog(),
          .least = usual.getClampingThresMinLog(),
          .most = usual.getClampingThresMaxLog(),
          .occupied_from = usual.getOccupancyThresLog()};
}

ScanAccumulator::ScanAccumulator(const OccupancyOptions& options)
    : rule_(LogOddsRule::of_octomap()),
      has_log_odds_(!options.sticky_hits),
      seen_through_(static_cast<unsigned>(options.remove_seen_through)) {}

void ScanAccumulator::take(CellBlock& block) {
  if (has_log_odds_) weigh(block);
  if (seen_through_ > 0) count_looks(block);
  block.hit = block.free = {};
}

// A cell that was hit in a scan was not free in it.
void ScanAccumulator::weigh(CellBlock& block) const {
  if (!block.log_odds) {
    block.log_odds = std::make_unique<std::array<float, 512>>();
    block.log_odds->fill(std::numeric_limits<float>::quiet_NaN());
  }
  const auto add = [&](std::size_t cell, float change) {
    float& value = (*block.log_odds)[cell];
    value = std::clamp((std::isnan(value) ? 0.0f : value) + change, rule_.least, rule_.most);
  };
  for (std::size_t word = 0; word < block.hit.size(); ++word) {
    const std::uint64_t hit = block.hit[word], free = block.free[word] & ~hit;
    for_each_bit(free, [&](std::size_t bit) { add(64 * word + bit, rule_.miss); });
    for_each_bit(hit, [&](std::size_t bit) { add(64 * word + bit, rule_.hit); });
  }
}

void ScanAccumulator::count_looks(CellBlock& block) {
  const auto [found, is_new] = looks_.try_emplace(&block);
  Looks& looks = found->second;
  constexpr std::size_t hashed = 48;  // its place in the table, about
  if (is_new) looks_bytes_ += sizeof(Looks) + hashed;
  BlockBits through;
  for (std::size_t word = 0; word < through.size(); ++word) {
    through[word] = block.free[word] & ~block.hit[word];
    looks.hit[word] |= block.hit[word];
    looks.free[word] |= block.free[word];
  }
  looks_bytes_ += looks.hits.add(block.hit) + looks.through.add(through);
}

void ScanAccumulator::settle(CellBlocks& blocks) {
  if (has_log_odds_) blocks.for_each([&](CellBlock& block) { settle_by_log_odds(block); });
  for (const auto& [block, looks] : looks_) settle_by_looks(*block, looks);
}

void ScanAccumulator::settle_by_log_odds(CellBlock& block) const {
  block.hit = bits_where(
      *block.log_odds, [](float a, float b) { return a >= b; }, rule_.occupied_from);
  block.free = bits_where(
      *block.log_odds, [](float a, float b) { return a < b; }, rule_.occupied_from);
}

void ScanAccumulator::settle_by_looks(CellBlock& block, const Looks& looks) {
  const BlockBits often = looks.through.more_than(seen_through_ - 1);
  const BlockBits mostly = looks.through.more_than(looks.hits);
  block.free = looks.free;
  for (std::size_t word = 0; word < often.size(); ++word) {
    const std::uint64_t gone = looks.hit[word] & often[word] & mostly[word];
    block.hit[word] = looks.hit[word] & ~gone;
    removed_ += static_cast<std::size_t>(std::popcount(gone));
  }
}

std::size_t ScanAccumulator::kept_bytes(std::size_t blocks) const {
  return looks_bytes_ + (has_log_odds_ ? blocks * sizeof(std::array<float, 512>) : 0);
}

}  // namespace roadbed::map::occupancy::octree
