#pragma once

#include <array>
#include <cstdint>

namespace roadbed::map::inline occupancy::inline laz {

/// The middle of five kept values. A new one takes the place of the largest until one is not below
/// the middle, then of the smallest until one is not above it.
class RunningMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }

  void add(std::int32_t value) {
    if (drops_largest_) {
      drops_largest_ = value < sorted_[2];
      std::size_t i = 4;
      for (; i > 0 && value < sorted_[i - 1]; --i) sorted_[i] = sorted_[i - 1];
      sorted_[i] = value;
    } else {
      drops_largest_ = value <= sorted_[2];
      std::size_t i = 0;
      for (; i < 4 && sorted_[i + 1] < value; ++i) sorted_[i] = sorted_[i + 1];
      sorted_[i] = value;
    }
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drops_largest_ = true;
};

}  // namespace roadbed::map::occupancy::laz
