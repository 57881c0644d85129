#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Decodes integers as what has to be added to a prediction: first in which of the intervals
/// (2ᵏ⁻¹, 2ᵏ] on either side of 0 that is, by a model for each context, then where in it.
class IntegerDecoder {
 public:
  /// @param bits      of the integers, 8, 16 or 32; their sums are taken modulo 2^bits.
  /// @param contexts  how many.
  explicit IntegerDecoder(std::uint32_t bits, std::uint32_t contexts = 1);

  std::int32_t decode(ArithmeticDecoder& from, std::int32_t prediction, std::uint32_t context = 0);

  /// The k of the last one.
  std::uint32_t k() const { return k_; }

 private:
  std::uint32_t correction(ArithmeticDecoder& from);

  std::uint32_t bits_, k_ = 0;
  std::vector<SymbolModel> intervals_;                   // of each context
  BitModel zero_or_one_;                                 // k = 0
  std::vector<std::optional<SymbolModel>> corrections_;  // of each k from 1, made when needed
};

}  // namespace roadbed::map::occupancy::laz
