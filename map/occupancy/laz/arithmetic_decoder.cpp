#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

#include <algorithm>

namespace roadbed::map::inline occupancy::inline laz {
namespace {

constexpr std::uint32_t kMostCount = 1u << SymbolModel::kShift;
constexpr std::uint32_t kBitShift = 13, kMostBits = 1u << kBitShift;

}  // namespace

SymbolModel::SymbolModel(std::uint32_t symbols)
    : symbols_(symbols),
      blocks_((symbols + kBlock - 1) / kBlock),
      cycle_(symbols),
      counts_(symbols, 1),
      begins_(kBlock * (blocks_ + (blocks_ + kBlock - 1) / kBlock), SymbolModel::kLastShare) {
  update();
  until_update_ = cycle_ = (symbols + 6) / 2;
}

void SymbolModel::update() {
  total_ += cycle_;
  if (total_ > kMostCount) {
    total_ = 0;
    for (std::uint32_t& count : counts_) {
      count = (count + 1) / 2;
      total_ += count;
    }
  }
  const std::uint32_t scale = 0x80000000u / total_;
  std::uint32_t sum = 0;
  for (std::uint32_t k = 0; k < symbols_; ++k) {
    begins_[k] = static_cast<std::int16_t>((scale * sum) >> (31 - kShift));
    sum += counts_[k];
  }
  for (std::uint32_t block = 0; block < blocks_; ++block) {
    begins_[blocks_ * kBlock + block] = begins_[block * kBlock];
  }
  cycle_ = std::min(cycle_ * 5 / 4, (symbols_ + 6) * 8);
  until_update_ = cycle_;
}

void BitModel::count(bool bit) {
  if (!bit) ++zeros_;
  if (--until_update_ > 0) return;
  bits_ += cycle_;
  if (bits_ > kMostBits) {
    bits_ = (bits_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == bits_) ++bits_;
  }
  zero_share_ = (0x80000000u / bits_ * zeros_) >> (31 - kBitShift);
  cycle_ = std::min(cycle_ * 5 / 4, 64u);
  until_update_ = cycle_;
}

ArithmeticDecoder::ArithmeticDecoder(std::string_view bytes) : bytes_(bytes) {
  value_ = next_four();
  at_ = 4;
}

std::uint32_t ArithmeticDecoder::last_four() const {
  std::uint32_t four = 0;
  for (std::size_t i = at_; i < at_ + 4; ++i) {
    four = four << 8 | (i < bytes_.size() ? static_cast<unsigned char>(bytes_[i]) : 0u);
  }
  return four;
}

std::uint32_t ArithmeticDecoder::bit(BitModel& model) {
  const std::uint32_t zero = model.zero_share_ * (length_ >> kBitShift);
  const bool is_one = value_ >= zero;
  if (is_one) value_ -= zero;
  length_ = is_one ? length_ - zero : zero;
  renormalize();
  model.count(is_one);
  return is_one ? 1 : 0;
}

std::uint32_t ArithmeticDecoder::part(std::uint32_t bits) {
  length_ >>= bits;
  const std::uint32_t value = value_ / length_;
  value_ -= length_ * value;
  renormalize();
  return value & ((1u << bits) - 1);
}

std::uint32_t ArithmeticDecoder::raw_bits(std::uint32_t bits) {
  if (bits <= 19) return part(bits);
  const std::uint32_t low = part(16);
  return part(bits - 16) << 16 | low;
}

std::uint64_t ArithmeticDecoder::raw_64() {
  const std::uint64_t low = raw_bits(32);
  return std::uint64_t{raw_bits(32)} << 32 | low;
}

}  // namespace roadbed::map::occupancy::laz
