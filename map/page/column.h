#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace roadbed::map::inline page {

/// Whole numbers as text that a page holds and its scripts read fast (scripts/decode.js): each as
/// 2n, or -2n - 1 of a negative one, in groups of seven bits, the lowest first, all but a number's
/// last group with the eighth bit set; the bytes in base64 (RFC 4648).
class Column {
 public:
  void add(std::int64_t number);

  /// The difference from the number that was added in this way before, at first from 0.
  void add_step(std::int64_t number);

  std::string text() const;

 private:
  std::string bytes_;
  std::int64_t last_ = 0;
};

/// Bytes in base64.
std::string base64(std::string_view bytes);

}  // namespace roadbed::map::page
