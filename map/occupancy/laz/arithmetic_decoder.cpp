#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

#include <algorithm>
#include <bit>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace roadbed::map::inline occupancy::inline laz {
namespace {

constexpr std::uint32_t kSymbolShift = 15, kMostCount = 1u << kSymbolShift;
constexpr std::uint32_t kBitShift = 13, kMostBits = 1u << kBitShift;
constexpr std::int16_t kLastShare = kMostCount - 1;

// How many of a block, in ascending order, begin at or before a share.
std::uint32_t begun(const std::int16_t* begins, std::int16_t share) {
#ifdef __SSE2__
  const __m128i at = _mm_set1_epi16(share);
  const auto* halves = reinterpret_cast<const __m128i*>(begins);
  const __m128i beyond = _mm_packs_epi16(_mm_cmpgt_epi16(_mm_loadu_si128(halves), at),
                                         _mm_cmpgt_epi16(_mm_loadu_si128(halves + 1), at));
  return static_cast<std::uint32_t>(
      std::countr_zero(static_cast<std::uint32_t>(_mm_movemask_epi8(beyond)) | 0x10000u));
#else
  return static_cast<std::uint32_t>(std::upper_bound(begins, begins + 16, share) - begins);
#endif
}

}  // namespace

SymbolModel::SymbolModel(std::uint32_t symbols)
    : symbols_(symbols),
      blocks_((symbols + kBlock - 1) / kBlock),
      cycle_(symbols),
      counts_(symbols, 1),
      begins_(kBlock * (blocks_ + (blocks_ + kBlock - 1) / kBlock), kLastShare) {
  update();
  until_update_ = cycle_ = (symbols + 6) / 2;
}

std::uint32_t SymbolModel::symbol_at(std::uint32_t share) const {
  const auto at = static_cast<std::int16_t>(std::min<std::uint32_t>(share, kLastShare));
  const std::int16_t* begins = begins_.data();
  std::uint32_t block = 0;
  if (blocks_ > 1) {
    const std::int16_t* of_blocks = begins + blocks_ * kBlock;
    block = begun(of_blocks, at);
    for (std::uint32_t i = kBlock; i < blocks_; i += kBlock) {
      block += begun(of_blocks + i, at);
    }
    block = std::min(block, blocks_) - 1;
  }
  return std::min(block * kBlock + begun(begins + block * kBlock, at), symbols_) - 1;
}

void SymbolModel::count(std::uint32_t symbol) {
  ++counts_[symbol];
  if (--until_update_ == 0) update();
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
    begins_[k] = static_cast<std::int16_t>((scale * sum) >> (31 - kSymbolShift));
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

std::uint32_t ArithmeticDecoder::next_four() const {
  std::uint32_t four = 0;
  if (at_ < bytes_.size()) {
    std::memcpy(&four, bytes_.data() + at_, std::min(sizeof(four), bytes_.size() - at_));
  }
  static_assert(std::endian::native == std::endian::little);
  return __builtin_bswap32(four);
}

// Until the length has its highest byte: 0 to 3 bytes more.
void ArithmeticDecoder::renormalize() {
  const auto bytes = static_cast<std::uint32_t>(std::countl_zero(length_)) / 8;
  if (bytes == 0) return;
  value_ = value_ << 8 * bytes | next_four() >> (32 - 8 * bytes);
  length_ <<= 8 * bytes;
  at_ += bytes;
}

std::uint32_t ArithmeticDecoder::symbol(SymbolModel& model) {
  const std::uint32_t before = length_;
  length_ >>= kSymbolShift;
  const std::uint32_t symbol = model.symbol_at(value_ / length_);
  const std::int16_t* begin = model.begins_.data() + symbol;
  const std::uint32_t low = static_cast<std::uint32_t>(begin[0]) * length_;
  const std::uint32_t high =
      symbol + 1 == model.symbols_ ? before : static_cast<std::uint32_t>(begin[1]) * length_;
  value_ -= low;
  length_ = high - low;
  renormalize();
  model.count(symbol);
  return symbol;
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
