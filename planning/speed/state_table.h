#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadbed::planning::inline speed {

/// Which state a search keeps in each cell of its grid: a table that is as large as what is kept,
/// not as the grid.
class StateTable {
 public:
  struct Cell {
    std::uint64_t key = kEmpty;
    int before_goal = -1, after_goal = -1;  ///< numbers of states; -1: none
  };

  /// The cell of a key, which may be new. Holds until the next call.
  Cell& at(std::uint64_t key) {
    if (2 * (used_ + 1) > cells_.size()) grow();
    Cell& cell = cells_[place_of(key)];
    if (cell.key == kEmpty) {
      cell.key = key;
      ++used_;
    }
    return cell;
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

  /// Of the key, or of the free place that it would have.
  std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = cells_.size() - 1;
    std::uint64_t mixed = key * 0x9E3779B97F4A7C15U;
    auto place = static_cast<std::size_t>(mixed ^ (mixed >> 32U)) & mask;
    while (cells_[place].key != kEmpty && cells_[place].key != key) place = (place + 1) & mask;
    return place;
  }

  void grow() {
    std::vector<Cell> old(2 * cells_.size());
    old.swap(cells_);
    for (const Cell& cell : old) {
      if (cell.key != kEmpty) cells_[place_of(cell.key)] = cell;
    }
  }

  std::vector<Cell> cells_ = std::vector<Cell>(1024);
  std::size_t used_ = 0;
};

}  // namespace roadbed::planning::speed
