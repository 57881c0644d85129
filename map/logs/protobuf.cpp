#include "roadbed/map/logs/protobuf.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {

std::optional<double> ProtoField::real() const {
  if (!is_fixed64 || !value) return std::nullopt;
  return std::bit_cast<double>(*value);
}

void ProtoReader::refuse(const std::string& found, const std::string& needed) const {
  throw InputError({.file = file_,
                    .place = place_,
                    .found = found,
                    .needed = needed,
                    .remedy = "record it anew, or leave the topic out"});
}

std::string_view ProtoReader::take(std::uint64_t count) {
  if (count > rest_.size()) {
    refuse(fmt::format("the message has {} bytes left", rest_.size()),
           fmt::format("{} as it says", count));
  }
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::uint64_t ProtoReader::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = static_cast<unsigned char>(take(1).front());
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  refuse("a whole number of more than 64 bits", "protobuf");
}

std::uint64_t ProtoReader::fixed(std::size_t size) {
  std::uint64_t value = 0;
  const std::string_view bytes = take(size);
  for (std::size_t i = size; i-- > 0;) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::optional<ProtoField> ProtoReader::next() {
  if (rest_.empty()) return std::nullopt;
  const std::uint64_t key = varint();
  ProtoField field{.number = static_cast<std::uint32_t>(key >> 3)};
  switch (key & 7) {
    case 0:
      field.value = varint();
      return field;
    case 1:
      field.value = fixed(8);
      field.is_fixed64 = true;
      return field;
    case 2:
      field.bytes = take(varint());
      return field;
    case 5:
      field.value = fixed(4);
      return field;
    default:
      refuse(fmt::format("a field of wire type {}", key & 7), "protobuf");
  }
}

}  // namespace roadbed::map::logs
