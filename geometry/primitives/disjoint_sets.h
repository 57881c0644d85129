#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace roadbed::geometry::inline primitives {

/// Numbers from 0 on in sets that grow together; each set is named by its least number. Steps per
/// question: O(log N) amortized, by path halving [Tarjan & van Leeuwen 1984,
/// doi:10.1145/62.2160].
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// The set that a number is in.
  std::size_t of(std::size_t number) {
    while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
    return number;
  }

  /// Makes one set of those of two numbers.
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = of(a), second = of(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace roadbed::geometry::primitives
