#include "roadbed/map/occupancy/clearance/cell_bits.h"

#include <bit>

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Bits `from` and above, or up to `to` and with it, of 0 … 63.
std::uint64_t from_bit(std::int64_t from) { return kAll << (from & 63); }
std::uint64_t up_to_bit(std::int64_t to) { return kAll >> (63 - (to & 63)); }

std::uint64_t word_of(const std::uint8_t* set, std::int64_t count) {
  std::uint64_t word = 0;
  for (std::int64_t i = 0; i < count; ++i) word |= std::uint64_t{set[i] != 0} << i;
  return word;
}

}  // namespace

CellBits::CellBits(const CellRange& range, const std::vector<std::uint8_t>& set)
    : range_(range),
      words_((range.width() + 63) / 64),
      first_band_(floor_div(range.from_y, kBandRows)) {
  if (range.empty()) return;
  const std::int64_t bands = floor_div(range.to_y - 1, kBandRows) - first_band_ + 1;
  rows_.resize(static_cast<std::size_t>(words_ * range.height()));
  bands_.resize(static_cast<std::size_t>(words_ * bands));
  for (std::int64_t y = range.from_y; y < range.to_y; ++y) {
    const std::uint8_t* cells = &set[range.index(range.from_x, y)];
    const auto to = static_cast<std::size_t>((y - range.from_y) * words_);
    const auto band = static_cast<std::size_t>((floor_div(y, kBandRows) - first_band_) * words_);
    for (std::int64_t i = 0; i < words_; ++i) {
      const auto word = static_cast<std::size_t>(i);
      rows_[to + word] =
          word_of(cells + 64 * i, std::min<std::int64_t>(64, range.width() - 64 * i));
      bands_[band + word] |= rows_[to + word];
    }
  }
}

bool CellBits::any_in_band(std::int64_t band, std::int64_t from_x, std::int64_t to_x) const {
  const std::int64_t from = from_x - range_.from_x, to = to_x - range_.from_x;
  const std::uint64_t* words = &bands_[static_cast<std::size_t>((band - first_band_) * words_)];
  std::int64_t at = from >> 6;
  const std::int64_t last = to >> 6;
  if (at == last) return (words[at] & from_bit(from) & up_to_bit(to)) != 0;
  std::uint64_t any = words[at] & from_bit(from);
  while (++at < last) any |= words[at];
  return (any | (words[last] & up_to_bit(to))) != 0;
}

std::optional<std::int64_t> CellBits::next_in_row(std::int64_t y, std::int64_t from_x,
                                                  std::int64_t to_x) const {
  if (from_x > to_x) return std::nullopt;
  const std::int64_t from = from_x - range_.from_x, to = to_x - range_.from_x;
  const std::uint64_t* words = row(y);
  std::uint64_t left = words[from >> 6] & from_bit(from);
  for (std::int64_t at = from >> 6;;) {
    if (left != 0) {
      const std::int64_t found = 64 * at + std::countr_zero(left);
      return found <= to ? std::optional(range_.from_x + found) : std::nullopt;
    }
    if (++at > to >> 6) return std::nullopt;
    left = words[at];
  }
}

std::optional<std::int64_t> CellBits::last_in_row(std::int64_t y, std::int64_t from_x,
                                                  std::int64_t to_x) const {
  if (from_x < to_x) return std::nullopt;
  const std::int64_t from = from_x - range_.from_x, to = to_x - range_.from_x;
  const std::uint64_t* words = row(y);
  std::uint64_t left = words[from >> 6] & up_to_bit(from);
  for (std::int64_t at = from >> 6;;) {
    if (left != 0) {
      const std::int64_t found = 64 * at + 63 - std::countl_zero(left);
      return found >= to ? std::optional(range_.from_x + found) : std::nullopt;
    }
    if (--at < to >> 6) return std::nullopt;
    left = words[at];
  }
}

}  // namespace roadbed::map::occupancy::clearance
