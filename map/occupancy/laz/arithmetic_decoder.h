#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

// What decodes a symbol has to be inlined, or states of decoders go through memory.
#define ROADBED_INLINE [[gnu::always_inline]] inline

namespace roadbed::map::inline occupancy::inline laz {

/// How often each of some symbols came so far, as decoder and encoder both count it.
/// @tparam kMost  as many symbols as there may be, up to 1,024.
template <std::uint32_t kMost>
class SymbolModel {
 public:
  explicit SymbolModel(std::uint32_t symbols = kMost);  ///< 2 to kMost, all as likely

 private:
  friend class ArithmeticDecoder;
  static constexpr std::uint32_t kBlock = 16, kBlocks = (kMost + kBlock - 1) / kBlock;
  static constexpr bool kIsFlat = kBlocks <= 4;
  static constexpr std::uint32_t kIndexBlocks = kIsFlat ? 0 : (kBlocks + kBlock - 1) / kBlock;
  static_assert(kIndexBlocks <= 4);
  static constexpr std::uint16_t kNever = 0xffff;

  template <std::uint32_t kCount>
  static std::size_t begun(const std::uint16_t* begins, std::uint32_t share);
  const std::uint16_t* end_at(std::uint32_t share) const;
  std::uint32_t count_before(const std::uint16_t* end);
  void update();

  // Where the share of 2¹⁵ begins of each symbol, of each block of them; kNever of what is none.
  alignas(64) std::array<std::uint16_t, kBlock * kIndexBlocks> block_begins_;
  std::uint32_t symbols_, total_ = 0, cycle_, until_update_ = 0;
  alignas(32) std::array<std::uint16_t, kBlock*(kBlocks + 1)> begins_;
  std::array<std::uint16_t, kMost> counts_;
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
  static constexpr std::uint32_t kShareBits = 15, kBitShareBits = 13;

  ArithmeticDecoder() = default;
  explicit ArithmeticDecoder(std::string_view bytes) : bytes_(bytes) {  ///< which have to stay
    value_ = std::min(next_four(), length_ - 1);  // no encoder begins otherwise
    at_ = 4;
  }

  template <std::uint32_t kMost>
  std::uint32_t symbol(SymbolModel<kMost>& model);
  std::uint32_t bit(BitModel& model);
  std::uint32_t raw_bits(std::uint32_t bits);  ///< 1 to 32, all values as likely
  std::uint64_t raw_64();

  /// Bytes taken so far.
  std::size_t used() const { return at_; }
  /// Goes past the end: what was decoded is nothing that an encoder writes.
  void break_off() { at_ = bytes_.size() + 1; }
  bool is_past_end() const { return at_ > bytes_.size(); }

 private:
  std::uint32_t next_four() const;
  static std::uint32_t last_four(std::string_view bytes, std::size_t at);
  void renormalize();
  std::uint32_t part(std::uint32_t bits);

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::uint32_t value_ = 0, length_ = 0xffffffffu;  // value < length
};

// Which of 16, in ascending order, begin at or before a share: a bit each.
ROADBED_INLINE std::uint32_t begun_of_block(const std::uint16_t* begins, std::uint32_t share) {
#ifdef __SSE2__
  const __m128i at = _mm_set1_epi16(static_cast<std::int16_t>(share)), zero = _mm_setzero_si128();
  const auto* halves = reinterpret_cast<const __m128i*>(begins);
  const __m128i begun =
      _mm_packs_epi16(_mm_cmpeq_epi16(_mm_subs_epu16(_mm_load_si128(halves), at), zero),
                      _mm_cmpeq_epi16(_mm_subs_epu16(_mm_load_si128(halves + 1), at), zero));
  return static_cast<std::uint32_t>(_mm_movemask_epi8(begun));
#else
  std::uint32_t begun = 0;
  for (std::uint32_t i = 0; i < 16; ++i) begun |= (begins[i] <= share ? 1u : 0u) << i;
  return begun;
#endif
}

template <std::uint32_t kMost>
SymbolModel<kMost>::SymbolModel(std::uint32_t symbols) : symbols_(symbols), cycle_(symbols) {
  begins_.fill(kNever);
  block_begins_.fill(kNever);
  counts_.fill(1);
  update();
  until_update_ = cycle_ = (symbols + 6) / 2;
}

template <std::uint32_t kMost>
template <std::uint32_t kCount>
ROADBED_INLINE std::size_t SymbolModel<kMost>::begun(const std::uint16_t* begins,
                                                     std::uint32_t share) {
  std::uint64_t begun = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    begun += std::uint64_t{begun_of_block(begins + i * kBlock, share)} << i * kBlock;
  }
  return static_cast<std::size_t>(std::countr_one(begun));
}

// Where the symbol ends that a share belongs to.
template <std::uint32_t kMost>
ROADBED_INLINE const std::uint16_t* SymbolModel<kMost>::end_at(std::uint32_t share) const {
  const std::uint16_t* begins = begins_.data();
  if constexpr (kIsFlat) return begins + begun<kBlocks>(begins, share);
  begins += (begun<kIndexBlocks>(block_begins_.data(), share) - 1) * kBlock;
  return begins + begun<1>(begins, share);
}

template <std::uint32_t kMost>
ROADBED_INLINE std::uint32_t SymbolModel<kMost>::count_before(const std::uint16_t* end) {
  const auto symbol = static_cast<std::uint32_t>(end - begins_.data()) - 1;
  ++counts_[symbol];
  if (--until_update_ == 0) [[unlikely]]
    update();
  return symbol;
}

template <std::uint32_t kMost>
[[gnu::noinline]] void SymbolModel<kMost>::update() {
  constexpr std::uint32_t shift = ArithmeticDecoder::kShareBits;
  total_ += cycle_;
  if (total_ > 1u << shift) {
    total_ = 0;
    for (std::uint32_t k = 0; k < symbols_; ++k) {
      counts_[k] = static_cast<std::uint16_t>((counts_[k] + 1) / 2);
      total_ += counts_[k];
    }
  }
  const std::uint32_t scale = 0x80000000u / total_;
  std::uint32_t sum = 0;
  for (std::uint32_t k = 0; k < symbols_; ++k) {
    begins_[k] = static_cast<std::uint16_t>((scale * sum) >> (31 - shift));
    sum += counts_[k];
  }
  if constexpr (!kIsFlat) {
    for (std::uint32_t i = 0; i < kBlocks; ++i) block_begins_[i] = begins_[i * kBlock];
  }
  cycle_ = std::min(cycle_ * 5 / 4, (symbols_ + 6) * 8);
  until_update_ = cycle_;
}

ROADBED_INLINE std::uint32_t ArithmeticDecoder::next_four() const {
  static_assert(std::endian::native == std::endian::little);
  if (at_ + 4 > bytes_.size()) [[unlikely]]
    return last_four(bytes_, at_);
  std::uint32_t four = 0;
  std::memcpy(&four, bytes_.data() + at_, sizeof(four));
  return __builtin_bswap32(four);
}

// Until the length, which is not 0, has its highest byte: 0 to 3 bytes more, without a branch that
// nobody foresees.
ROADBED_INLINE void ArithmeticDecoder::renormalize() {
  const std::uint32_t bits = static_cast<std::uint32_t>(__builtin_clz(length_)) & ~7u;
  value_ = static_cast<std::uint32_t>((std::uint64_t{value_} << 32 | next_four()) << bits >> 32);
  length_ <<= bits;
  at_ += bits / 8;
}

template <std::uint32_t kMost>
ROADBED_INLINE std::uint32_t ArithmeticDecoder::symbol(SymbolModel<kMost>& model) {
  const std::uint32_t before = length_;
  length_ >>= kShareBits;
  const std::uint16_t* end = model.end_at(value_ / length_);
  const std::uint32_t low = end[-1] * length_;
  const std::uint64_t high = std::uint64_t{end[0]} * length_;  // of the last symbol beyond `before`
  value_ -= low;
  length_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(high, before)) - low;
  renormalize();
  return model.count_before(end);
}

ROADBED_INLINE std::uint32_t ArithmeticDecoder::bit(BitModel& model) {
  const std::uint32_t zero = model.zero_share_ * (length_ >> kBitShareBits);
  const bool is_one = value_ >= zero;
  if (is_one) value_ -= zero;
  length_ = is_one ? length_ - zero : zero;
  renormalize();
  model.count(is_one);
  return is_one ? 1 : 0;
}

ROADBED_INLINE std::uint32_t ArithmeticDecoder::part(std::uint32_t bits) {
  length_ >>= bits;
  const std::uint32_t value = value_ / length_;
  value_ -= length_ * value;
  renormalize();
  return value & ((1u << bits) - 1);
}

ROADBED_INLINE std::uint32_t ArithmeticDecoder::raw_bits(std::uint32_t bits) {
  if (bits <= 19) return part(bits);
  const std::uint32_t low = part(16);
  return part(bits - 16) << 16 | low;
}

inline std::uint64_t ArithmeticDecoder::raw_64() {
  const std::uint64_t low = raw_bits(32);
  return std::uint64_t{raw_bits(32)} << 32 | low;
}

}  // namespace roadbed::map::occupancy::laz
