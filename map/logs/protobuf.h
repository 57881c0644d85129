#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// Puts the fields of a message one after the other, in the wire format of Protocol Buffers
/// [https://protobuf.dev/programming-guides/encoding]. What is 0 is written, too.
class ProtoWriter {
 public:
  /// A string, bytes, or a message.
  ProtoWriter& bytes(std::uint32_t field, std::string_view value) {
    key(field, 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtoWriter& message(std::uint32_t field, const ProtoWriter& value) {
    return bytes(field, value.bytes_);
  }
  /// An int64 that is not negative, an enum or a bool.
  ProtoWriter& whole(std::uint32_t field, std::uint64_t value) {
    key(field, 0);
    varint(value);
    return *this;
  }
  ProtoWriter& fixed32(std::uint32_t field, std::uint32_t value) {
    key(field, 5);
    put(value, 4);
    return *this;
  }
  ProtoWriter& number(std::uint32_t field, double value) {
    key(field, 1);
    put(std::bit_cast<std::uint64_t>(value), 8);
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void key(std::uint32_t field, unsigned wire_type) { varint((field << 3) | wire_type); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>(value | 0x80));
    bytes_.push_back(static_cast<char>(value));
  }
  void put(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i, value >>= 8) bytes_.push_back(static_cast<char>(value & 0xff));
  }

  std::string bytes_;
};

/// A field of a message as it stands: its number, and its value as its wire type has it.
struct ProtoField {
  std::uint32_t number = 0;
  std::optional<std::uint64_t> value = {};  ///< of a varint or fixed number
  std::string_view bytes = {};              ///< of a string, bytes, or a message

  /// Of a double; none where it is something else.
  std::optional<double> real() const;

  bool is_fixed64 = false;
};

/// Takes the fields off a message, in turn.
class ProtoReader {
 public:
  /// @param file  and `place` are for messages. The bytes must outlive it.
  ProtoReader(std::string_view message, const std::string& file, const std::string& place)
      : rest_(message), file_(file), place_(place) {}

  /// None at the end. @throws InputError if the message is cut off, or no protobuf.
  std::optional<ProtoField> next();

  /// A reader of a message in this one.
  ProtoReader inner(const ProtoField& field) const { return {field.bytes, file_, place_}; }

  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const;

 private:
  std::uint64_t varint();
  std::string_view take(std::uint64_t count);
  std::uint64_t fixed(std::size_t size);

  std::string_view rest_;
  const std::string& file_;
  const std::string& place_;
};

}  // namespace roadbed::map::logs
