#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// A table of FlatBuffers, read in place; every place is checked before it is read. The library
/// reads unchecked, and its verifier needs code made from Arrow's schemas, of which six tables are
/// used here.
class FlatTable {
 public:
  /// The root table of a buffer. Its place in the file is for messages.
  static FlatTable root(std::string_view buffer, const std::string& file);

  /// A scalar field; `fallback` where it is left out.
  template <class Number>
  Number number(int field, Number fallback) const {
    const auto at = place_of(field);
    return at ? value<Number>(*at) : fallback;
  }

  std::optional<FlatTable> table(int field) const;
  std::string_view text(int field) const;

  /// How many elements a vector has; 0 where it is left out. `size` is that of an element: all are
  /// there.
  std::uint32_t count(int field, std::size_t size) const;
  FlatTable table_of(int field, std::uint32_t index) const;

  /// A number at `offset` of the element `index`, a struct of `size` bytes.
  template <class Number>
  Number number_of(int field, std::uint32_t index, std::size_t size, std::size_t offset) const {
    return value<Number>(*vector_at(field) + 4 + index * size + offset);
  }

 private:
  FlatTable(std::string_view buffer, std::size_t at, const std::string& file)
      : buffer_(buffer), at_(at), file_(&file) {}

  [[noreturn]] void refuse(std::size_t at) const;
  std::uint64_t bits(std::size_t at, std::size_t size) const;
  template <class Number>
  Number value(std::size_t at) const {
    return static_cast<Number>(bits(at, sizeof(Number)));
  }
  std::optional<std::size_t> place_of(int field) const;
  std::optional<std::size_t> vector_at(int field) const;
  std::size_t follow(std::size_t at) const;

  std::string_view buffer_;
  std::size_t at_;
  const std::string* file_;
};

}  // namespace roadbed::map::logs
