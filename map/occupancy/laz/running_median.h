#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace roadbed::map::inline occupancy::inline laz {

/// The middle of five kept values. A new one takes the place of the largest until one is not below
/// the middle, then of the smallest until one is not above it.
class RunningMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }

  void add(std::int32_t value) {
    // The other four, then the new one in its place among them: without branches.
    const std::int32_t* rest = sorted_.data() + first_kept_;
    const std::int32_t a = rest[0], b = rest[1], c = rest[2], d = rest[3], middle = sorted_[2];
    first_kept_ = first_kept_ == 0 ? value >= middle : value > middle;
    sorted_ = {std::min(a, value), std::max(a, std::min(b, value)), std::max(b, std::min(c, value)),
               std::max(c, std::min(d, value)), std::max(d, value)};
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  std::size_t first_kept_ = 0;  // 0: the largest goes, 1: the smallest
};

}  // namespace roadbed::map::occupancy::laz
