#include "roadbed/map/logs/flat_tables.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {

FlatTable FlatTable::root(std::string_view buffer, const std::string& file) {
  FlatTable start(buffer, 0, file);
  return {buffer, start.follow(0), file};
}

std::optional<FlatTable> FlatTable::table(int field) const {
  const auto at = place_of(field);
  if (!at) return std::nullopt;
  return FlatTable(buffer_, follow(*at), *file_);
}

std::string_view FlatTable::text(int field) const {
  const std::uint32_t size = count(field, 1);
  return size == 0 ? std::string_view() : buffer_.substr(*vector_at(field) + 4, size);
}

std::uint32_t FlatTable::count(int field, std::size_t size) const {
  const auto at = vector_at(field);
  if (!at) return 0;
  const auto elements = value<std::uint32_t>(*at);
  if (elements > (buffer_.size() - *at - 4) / size) refuse(*at);
  return elements;
}

FlatTable FlatTable::table_of(int field, std::uint32_t index) const {
  return {buffer_, follow(*vector_at(field) + 4 + std::size_t{4} * index), *file_};
}

void FlatTable::refuse(std::size_t at) const {
  throw InputError({.file = *file_,
                    .element = "Arrow metadata",
                    .found = fmt::format("refers to byte {} of {}", at, buffer_.size()),
                    .needed = "places within it",
                    .remedy = "copy or write the file anew"});
}

std::uint64_t FlatTable::bits(std::size_t at, std::size_t size) const {
  if (at > buffer_.size() || buffer_.size() - at < size) refuse(at);
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = (value << 8) | static_cast<unsigned char>(buffer_[at + i]);
  }
  return value;
}

// A table begins with the way back to its list of fields: bytes of it, bytes of the table, then
// where in the table each field is.
std::optional<std::size_t> FlatTable::place_of(int field) const {
  const auto back = static_cast<std::int64_t>(value<std::int32_t>(at_));
  const std::int64_t fields = static_cast<std::int64_t>(at_) - back;
  if (fields < 0) refuse(at_);
  const auto list = static_cast<std::size_t>(fields);
  const std::size_t entry = 4 + 2 * static_cast<std::size_t>(field);
  if (entry + 2 > value<std::uint16_t>(list)) return std::nullopt;
  const auto offset = value<std::uint16_t>(list + entry);
  if (offset == 0) return std::nullopt;
  return at_ + offset;
}

std::optional<std::size_t> FlatTable::vector_at(int field) const {
  const auto at = place_of(field);
  if (!at) return std::nullopt;
  return follow(*at);
}

std::size_t FlatTable::follow(std::size_t at) const {
  const std::size_t to = at + value<std::uint32_t>(at);
  if (to >= buffer_.size()) refuse(to);
  return to;
}

}  // namespace roadbed::map::logs
