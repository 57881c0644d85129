#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadbed::map::inline edit {

/// What of a line of points is there, in rows from 0; a row may lie between two of them.
///
///     row    0     1     2     3     4
///            ●─────●──╎──●─────●──╎──●     from 1.5, to 3.5, 5 rows: 4 points
struct RowSpan {
  double from = 0.0, to = 0.0;
  std::size_t rows = 0;  ///< of the whole line

  double last_row() const { return static_cast<double>(rows) - 1.0; }
  bool starts() const { return from <= 0.0; }
  bool ends() const { return to >= last_row(); }
  bool is_whole() const { return starts() && ends(); }

  /// Points of the part.
  double points() const { return std::ceil(to) - std::floor(from) + 1.0; }

  /// Whether it may be what is left of a line, of as many points.
  bool fits(std::size_t count) const {
    return from >= 0.0 && from < to && to <= last_row() && points() == static_cast<double>(count);
  }

  /// The row of the whole line that a row of the part is.
  double whole_row(double row) const {
    const auto at = [&](double point) { return std::clamp(std::floor(from) + point, from, to); };
    const double before = std::floor(row);
    return std::lerp(at(before), at(before + 1.0), row - before);
  }

  /// The rows of the whole line that a part of this part is.
  RowSpan part(double part_from, double part_to) const {
    return {whole_row(part_from), whole_row(part_to), rows};
  }
};

}  // namespace roadbed::map::edit
