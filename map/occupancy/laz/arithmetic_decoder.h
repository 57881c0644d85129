#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace roadbed::map::inline occupancy::inline laz {

/// How often each of some symbols came so far, as decoder and encoder both count it.
class SymbolModel {
 public:
  static constexpr std::uint32_t kShift = 15;
  static constexpr std::int16_t kLastShare = (1 << kShift) - 1;

  explicit SymbolModel(std::uint32_t symbols);  ///< 2 to 2,048, all as likely

 private:
  friend class ArithmeticDecoder;
  static constexpr std::uint32_t kBlock = 16;

  static std::uint32_t begun(const std::int16_t* begins, std::int16_t share);
  std::uint32_t symbol_at(std::uint32_t share) const;
  void count(std::uint32_t symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }
  void update();

  std::uint32_t symbols_, blocks_;
  std::uint32_t total_ = 0, cycle_, until_update_ = 0;
  std::vector<std::uint32_t> counts_;
  // Where each symbol's share of 2¹⁵ begins, in blocks; then where those of the blocks begin. What
  // is left over in the last block of either is 2¹⁵ - 1.
  std::vector<std::int16_t> begins_;
};

/// The same of a bit.
class BitModel {
 private:
  friend class ArithmeticDecoder;
  void count(bool bit);

  std::uint32_t zero_share_ = 1u << 12;
  std::uint32_t zeros_ = 1, bits_ = 2, cycle_ = 4, until_update_ = 4;
};

/// Adaptive arithmetic decoding with 32 bits [A. Said, Introduction to Arithmetic Coding, HP Labs
/// HPL-2004-76, 2004], as LAZ files use it. Bytes beyond the end count as 0; `is_past_end` tells.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  explicit ArithmeticDecoder(std::string_view bytes);  ///< which have to stay

  std::uint32_t symbol(SymbolModel& model);
  std::uint32_t bit(BitModel& model);
  std::uint32_t raw_bits(std::uint32_t bits);  ///< 1 to 32, all values as likely
  std::uint64_t raw_64();

  /// Bytes taken so far.
  std::size_t used() const { return at_; }
  bool is_past_end() const { return at_ > bytes_.size(); }

 private:
  std::uint32_t next_four() const;
  std::uint32_t last_four() const;
  void renormalize();
  std::uint32_t part(std::uint32_t bits);

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::uint32_t value_ = 0, length_ = 0xffffffffu;  // value < length
};

// How many of a block, in ascending order, begin at or before a share.
inline std::uint32_t SymbolModel::begun(const std::int16_t* begins, std::int16_t share) {
#ifdef __SSE2__
  const __m128i at = _mm_set1_epi16(share);
  const auto* halves = reinterpret_cast<const __m128i*>(begins);
  const __m128i beyond = _mm_packs_epi16(_mm_cmpgt_epi16(_mm_loadu_si128(halves), at),
                                         _mm_cmpgt_epi16(_mm_loadu_si128(halves + 1), at));
  return static_cast<std::uint32_t>(
      std::countr_zero(static_cast<std::uint32_t>(_mm_movemask_epi8(beyond)) | 0x10000u));
#else
  return static_cast<std::uint32_t>(std::upper_bound(begins, begins + kBlock, share) - begins);
#endif
}

inline std::uint32_t SymbolModel::symbol_at(std::uint32_t share) const {
  const auto at = static_cast<std::int16_t>(std::min<std::uint32_t>(share, kLastShare));
  const std::int16_t* begins = begins_.data();
  std::uint32_t symbol = 0;
  if (blocks_ <= 4) {
    for (std::uint32_t i = 0; i < blocks_; ++i) symbol += begun(begins + i * kBlock, at);
  } else {
    const std::int16_t* of_blocks = begins + blocks_ * kBlock;
    for (std::uint32_t i = 0; i < blocks_; i += kBlock) symbol += begun(of_blocks + i, at);
    symbol = (std::min(symbol, blocks_) - 1) * kBlock;
    symbol += begun(begins + symbol, at);
  }
  return std::min(symbol, symbols_) - 1;
}

inline std::uint32_t ArithmeticDecoder::next_four() const {
  static_assert(std::endian::native == std::endian::little);
  if (at_ + 4 > bytes_.size()) return last_four();
  std::uint32_t four = 0;
  std::memcpy(&four, bytes_.data() + at_, sizeof(four));
  return __builtin_bswap32(four);
}

// Until the length has its highest byte: 0 to 3 bytes more, without a branch that nobody foresees.
inline void ArithmeticDecoder::renormalize() {
  const std::uint32_t bits = static_cast<std::uint32_t>(std::countl_zero(length_)) & ~7u;
  value_ = value_ << bits | next_four() >> 1 >> (31 - bits);
  length_ <<= bits;
  at_ += bits / 8;
}

inline std::uint32_t ArithmeticDecoder::symbol(SymbolModel& model) {
  const std::uint32_t before = length_;
  length_ >>= SymbolModel::kShift;
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

}  // namespace roadbed::map::occupancy::laz
