#include "roadbed/map/occupancy/laz/integer_decoder.h"

#include <algorithm>

namespace roadbed::map::inline occupancy::inline laz {
namespace {

constexpr std::uint32_t kModelledBits = 8;  // the high ones; what is below is stored as it is

}  // namespace

IntegerDecoder::IntegerDecoder(std::uint32_t bits, std::uint32_t contexts)
    : bits_(bits), intervals_(contexts, SymbolModel(bits + 1)), corrections_(bits) {}

std::int32_t IntegerDecoder::decode(ArithmeticDecoder& from, std::int32_t prediction,
                                    std::uint32_t context) {
  k_ = from.symbol(intervals_[context]);
  const std::uint32_t sum = static_cast<std::uint32_t>(prediction) + correction(from);
  return static_cast<std::int32_t>(bits_ < 32 ? sum & ((1u << bits_) - 1) : sum);
}

std::uint32_t IntegerDecoder::correction(ArithmeticDecoder& from) {
  if (k_ == 0) return from.bit(zero_or_one_);
  if (k_ == 32) return 0x80000000u;
  std::optional<SymbolModel>& model = corrections_[k_ - 1];
  if (!model) model.emplace(1u << std::min(k_, kModelledBits));
  std::uint32_t value = from.symbol(*model);
  if (k_ > kModelledBits) {
    const std::uint32_t below = k_ - kModelledBits;
    value = value << below | from.raw_bits(below);
  }
  // The upper half is [2ᵏ⁻¹ + 1, 2ᵏ], the lower one [-(2ᵏ - 1), -2ᵏ⁻¹].
  const std::uint32_t is_lower = value >> (k_ - 1) ^ 1u;
  return value + 1 - (is_lower << k_);
}

}  // namespace roadbed::map::occupancy::laz
