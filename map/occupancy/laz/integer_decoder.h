#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Decodes integers as what has to be added to a prediction: first in which of the intervals
/// (2ᵏ⁻¹, 2ᵏ] on either side of 0 that is, by a model for each context, then where in it.
/// @tparam kBits  of the integers, 8, 16 or 32; their sums are taken modulo 2^kBits.
template <std::uint32_t kBits>
class IntegerDecoder {
 public:
  explicit IntegerDecoder(std::uint32_t contexts = 1) : intervals_(contexts) {}

  /// Both of the following.
  ROADBED_INLINE std::int32_t decode(ArithmeticDecoder& from, std::int32_t prediction,
                                     std::uint32_t context = 0) {
    take_interval(from, context);
    return take_sum(from, prediction);
  }
  ROADBED_INLINE void take_interval(ArithmeticDecoder& from, std::uint32_t context) {
    k_ = from.symbol(intervals_[context]);
  }
  ROADBED_INLINE std::int32_t take_sum(ArithmeticDecoder& from, std::int32_t prediction) {
    const std::uint32_t sum = static_cast<std::uint32_t>(prediction) + correction(from);
    return static_cast<std::int32_t>(kBits < 32 ? sum & ((1u << kBits) - 1) : sum);
  }

  /// The k of the last one.
  std::uint32_t k() const { return k_; }

 private:
  // The high ones; what is below is stored as it is.
  static constexpr std::uint32_t kModelledBits = 8;
  using Model = SymbolModel<1u << kModelledBits>;

  ROADBED_INLINE std::uint32_t correction(ArithmeticDecoder& from) {
    if (k_ == 0) return from.bit(zero_or_one_);
    if (k_ == 32) [[unlikely]]
      return 0x80000000u;
    std::unique_ptr<Model>& model = corrections_[k_ - 1];
    if (!model) [[unlikely]]
      model = std::make_unique<Model>(1u << std::min(k_, kModelledBits));
    std::uint32_t value = from.symbol(*model);
    if (k_ > kModelledBits) {
      const std::uint32_t below = k_ - kModelledBits;
      value = value << below | from.raw_bits(below);
    }
    // The upper half is [2ᵏ⁻¹ + 1, 2ᵏ], the lower one [-(2ᵏ - 1), -2ᵏ⁻¹].
    const std::uint32_t is_lower = value >> (k_ - 1) ^ 1u;
    return value + 1 - (is_lower << k_);
  }

  std::uint32_t k_ = 0;
  std::vector<SymbolModel<kBits + 1>> intervals_;          // of each context
  BitModel zero_or_one_;                                   // k = 0
  std::array<std::unique_ptr<Model>, kBits> corrections_;  // of each k from 1, made when needed
};

}  // namespace roadbed::map::occupancy::laz
