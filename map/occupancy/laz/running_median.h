#pragma once

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
    // The other four, then the new one in its place among them.
    const std::int32_t* rest = sorted_.data() + first_kept_;
    const std::int32_t a = rest[0], b = rest[1], c = rest[2], d = rest[3], middle = sorted_[2];
    first_kept_ = static_cast<std::size_t>(value > middle) |
                  (static_cast<std::size_t>(value == middle) & (first_kept_ ^ 1u));
    sorted_ = {least(a, value), most(a, least(b, value)), most(b, least(c, value)),
               most(c, least(d, value)), most(d, value)};
  }

 private:
  // GCC makes branches of std::min and std::max here, which nobody foresees.
  static std::int32_t least(std::int32_t a, std::int32_t b) {
    return b ^ ((a ^ b) & -static_cast<std::int32_t>(a < b));
  }
  static std::int32_t most(std::int32_t a, std::int32_t b) { return a ^ b ^ least(a, b); }

  std::array<std::int32_t, 5> sorted_{};
  std::size_t first_kept_ = 0;  // 0: the largest goes, 1: the smallest
};

}  // namespace roadbed::map::occupancy::laz
