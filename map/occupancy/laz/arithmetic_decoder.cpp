#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

#include <algorithm>

namespace roadbed::map::inline occupancy::inline laz {

void BitModel::count(bool bit) {
  constexpr std::uint32_t shift = ArithmeticDecoder::kBitShareBits;
  if (!bit) ++zeros_;
  if (--until_update_ > 0) return;
  bits_ += cycle_;
  if (bits_ > 1u << shift) {
    bits_ = (bits_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == bits_) ++bits_;
  }
  zero_share_ = (0x80000000u / bits_ * zeros_) >> (31 - shift);
  cycle_ = std::min(cycle_ * 5 / 4, 64u);
  until_update_ = cycle_;
}

std::uint32_t ArithmeticDecoder::last_four(std::string_view bytes, std::size_t at) {
  std::uint32_t four = 0;
  for (std::size_t i = at; i < at + 4; ++i) {
    four = four << 8 | (i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u);
  }
  return four;
}

}  // namespace roadbed::map::occupancy::laz
