#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace roadbed::map::inline occupancy::inline laz {

/// How often each of some symbols came so far, as decoder and encoder both count it.
class SymbolModel {
 public:
  explicit SymbolModel(std::uint32_t symbols);  ///< 2 to 2,048, all as likely

 private:
  friend class ArithmeticDecoder;
  static constexpr std::uint32_t kBlock = 16;

  std::uint32_t symbol_at(std::uint32_t share) const;
  void count(std::uint32_t symbol);
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
  void renormalize();
  std::uint32_t part(std::uint32_t bits);

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::uint32_t value_ = 0, length_ = 0xffffffffu;  // value < length
};

}  // namespace roadbed::map::occupancy::laz
