#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// Takes values off a message in CDR, the plain encoding of ROS 2, of either byte order [OMG
/// DDS-XTypes 1.3, 7.4.1]: each number stands at a multiple of its size from the message's head on.
class Cdr {
 public:
  /// @param file   and `place` are for messages. The bytes must outlive it.
  /// @throws InputError if the bytes do not begin as plain CDR.
  Cdr(std::string_view message, std::string file, std::string place);

  /// @throws InputError if the message ends before it; so do all below.
  template <class Number>
  Number number() {
    align(sizeof(Number));
    Number value;
    std::string_view bytes = take(sizeof(Number));
    if (is_big_ == (std::endian::native == std::endian::big)) {
      std::memcpy(&value, bytes.data(), sizeof(Number));
      return value;
    }
    char turned[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof(Number); ++i) turned[i] = bytes[sizeof(Number) - 1 - i];
    std::memcpy(&value, turned, sizeof(Number));
    return value;
  }

  /// On one line.
  std::string text();

  /// How many elements follow. @throws InputError if so many of `least_bytes` are not there.
  std::uint32_t count(std::size_t least_bytes);

  /// `count` bytes as they are.
  std::string_view take(std::size_t count);

  bool is_big_endian() const { return is_big_; }

  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const;

 private:
  void align(std::size_t size);

  std::string_view body_;
  std::size_t at_ = 0;
  std::string file_, place_;
  bool is_big_ = false;
};

}  // namespace roadbed::map::logs
