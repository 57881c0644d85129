#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace roadbed::map::sumo {

/// Numbers from 0 on in sets that grow together; each set is named by its least number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// The set that a number is in.
  std::uint32_t of(std::uint32_t number) {
    while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
    return number;
  }

  /// Makes one set of those of two numbers.
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t first = of(a), second = of(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace roadbed::map::sumo
