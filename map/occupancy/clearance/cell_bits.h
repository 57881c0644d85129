#pragma once

// Private to map/occupancy.

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/occupancy/octree/cell_range.h"

namespace roadbed::map::inline occupancy::inline clearance {

/// Which cells of a range are set: a bit a cell, 64 cells of a row to a word. For every eight rows
/// there is one more, in which a bit is set where it is in any of them.
class CellBits {
 public:
  static constexpr std::int64_t kBandRows = 8;

  CellBits() = default;
  /// @param set  not 0 where a cell of the range is set, row by row.
  CellBits(const CellRange& range, const std::vector<std::uint8_t>& set);

  const CellRange& range() const { return range_; }

  /// Whether one is set from `from_x` to `to_x` (with it) in rows 8·band to 8·band + 7.
  /// @pre the range holds these columns, and some of these rows; so below, with one row.
  bool any_in_band(std::int64_t band, std::int64_t from_x, std::int64_t to_x) const;

  /// The first that is set in a row, from `from_x` up to `to_x`, with it.
  std::optional<std::int64_t> next_in_row(std::int64_t y, std::int64_t from_x,
                                          std::int64_t to_x) const;

  /// The last that is set in a row, from `from_x` down to `to_x`, with it.
  std::optional<std::int64_t> last_in_row(std::int64_t y, std::int64_t from_x,
                                          std::int64_t to_x) const;

 private:
  const std::uint64_t* row(std::int64_t y) const {
    return &rows_[static_cast<std::size_t>((y - range_.from_y) * words_)];
  }

  CellRange range_;
  std::int64_t words_ = 0, first_band_ = 0;  // words of a row
  std::vector<std::uint64_t> rows_, bands_;
};

}  // namespace roadbed::map::occupancy::clearance
