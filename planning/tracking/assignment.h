#pragma once

#include <optional>
#include <vector>

namespace roadbed::planning::inline tracking {

/// A row and a column that may belong together, and what that costs.
struct PossiblePair {
  std::size_t row = 0, column = 0;
  double cost = 0.0;  ///< finite, 0 to the cost of none
};

/// Gives rows columns, each column to one row at most, at the least sum of costs; a row without a
/// column costs `cost_of_none`. Each group that no pair leads out of is settled by itself, by the
/// shortest augmenting paths of [Jonker, Volgenant 1987, doi:10.1007/BF02278710], O(rows² ·
/// columns); one of more than 100 rows the cheapest pair first, O(pairs log pairs).
/// @returns per row its column.
std::vector<std::optional<std::size_t>> assign(std::size_t rows, std::size_t columns,
                                               const std::vector<PossiblePair>& pairs,
                                               double cost_of_none);

}  // namespace roadbed::planning::tracking
