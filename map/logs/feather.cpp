#include "roadbed/map/logs/feather.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cstring>
#include <optional>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/flat_tables.h"
#include "roadbed/map/logs/unpack_block.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::string_view kMagic = "ARROW1";
constexpr std::uint8_t kIntType = 2, kFloatType = 3, kTextType = 5;
/// Fields of Arrow's tables that are read [Schema.fbs, Message.fbs, File.fbs].
namespace field {
constexpr int footer_schema = 1, footer_batches = 3, schema_endianness = 0, schema_fields = 1,
              name = 0, type_kind = 2, type = 3, children = 5, bit_width = 0, is_signed = 1,
              precision = 0, header_kind = 1, header = 2, length = 0, nodes = 1, buffers = 2,
              compression = 3, codec = 0;
}  // namespace field
constexpr std::size_t kBlockSize = 24, kPairSize = 16;

/// A column of the schema: its type, and where its buffers begin among those of a batch.
struct Place {
  std::uint8_t kind = 0;
  std::size_t bytes = 0;
  bool is_signed = true;
  std::uint32_t node = 0, first_buffer = 0;
};

class FeatherReader {
 public:
  FeatherReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes),
        name_(name),
        unpacked_left_(most_unpacked_of_rows(bytes.size())),
        rows_left_(most_unpacked_of_rows(bytes.size())) {}

  std::vector<FeatherColumn> read(std::vector<std::string> wanted,
                                  const std::vector<std::string>& texts) {
    numbers_ = wanted.size();
    wanted.insert(wanted.end(), texts.begin(), texts.end());
    constexpr std::size_t tail = 10;
    if (bytes_.size() < 8 + tail || !bytes_.ends_with(kMagic)) refuse("", "is cut off", kMagic);
    const std::size_t end = bytes_.size() - tail;
    const auto size = scalar<std::uint32_t>(end);
    if (size > end) refuse("footer", fmt::format("says that it has {} bytes", size), "fewer");
    const FlatTable footer = FlatTable::root(bytes_.substr(end - size, size), name_);
    const auto schema = footer.table(field::footer_schema);
    if (!schema) refuse("footer", "has no schema", "one");
    if (schema->number<std::int16_t>(field::schema_endianness, 0) != 0) {
      refuse("schema", "is big-endian", "little-endian");
    }
    find_columns(*schema, wanted);
    const std::uint32_t batches = footer.count(field::footer_batches, kBlockSize);
    for (std::uint32_t i = 0; i < batches; ++i) {
      const auto block = [&](std::size_t offset) { return block_number(footer, i, offset); };
      read_batch(block(0), footer.number_of<std::uint32_t>(field::footer_batches, i, kBlockSize, 8),
                 block(16));
    }
    return std::move(columns_);
  }

 private:
  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           std::string_view needed) const {
    throw InputError({.file = name_,
                      .element = element,
                      .found = found,
                      .needed = std::string(needed),
                      .remedy = "write the file anew"});
  }

  static std::uint64_t block_number(const FlatTable& footer, std::uint32_t index,
                                    std::size_t offset) {
    return footer.number_of<std::uint64_t>(field::footer_batches, index, kBlockSize, offset);
  }

  template <class Number>
  Number scalar(std::size_t at) const {
    Number value;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }

  void find_columns(const FlatTable& schema, const std::vector<std::string>& wanted) {
    columns_.resize(wanted.size());
    places_.resize(wanted.size());
    for (std::size_t c = 0; c < wanted.size(); ++c) columns_[c].name = wanted[c];
    std::vector<bool> found(wanted.size());
    std::uint32_t node = 0, buffer = 0;
    const std::uint32_t fields = schema.count(field::schema_fields, 4);
    for (std::uint32_t i = 0; i < fields; ++i) {
      const FlatTable column = schema.table_of(field::schema_fields, i);
      const auto kind = column.number<std::uint8_t>(field::type_kind, 0);
      for (std::size_t c = 0; c < wanted.size(); ++c) {
        if (column.text(field::name) != wanted[c]) continue;
        places_[c] =
            c < numbers_ ? place_of(column, kind, wanted[c]) : place_of_text(kind, wanted[c]);
        places_[c].node = node;
        places_[c].first_buffer = buffer;
        columns_[c].is_whole = kind == kIntType;
        found[c] = true;
      }
      if (column.count(field::children, 4) != 0) {
        refuse("schema", "has nested columns", "plain ones");
      }
      // Validity and values; texts and bytes have offsets between them.
      constexpr std::uint8_t binary = 4, null = 1;
      buffer += kind == null ? 0 : kind == binary || kind == kTextType ? 3 : 2;
      ++node;
    }
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      if (!found[c]) refuse("schema", "has no column " + wanted[c], "that column");
    }
  }

  Place place_of(const FlatTable& column, std::uint8_t kind, const std::string& name) const {
    Place place{.kind = kind};
    const auto type = column.table(field::type);
    if (kind == kIntType && type) {
      const auto bits = type->number<std::int32_t>(field::bit_width, 0);
      place.is_signed = type->number<std::uint8_t>(field::is_signed, 0) != 0;
      if (bits == 8 || bits == 16 || bits == 32 || bits == 64) {
        place.bytes = static_cast<std::size_t>(bits) / 8;
      }
    } else if (kind == kFloatType && type) {
      const auto precision = type->number<std::int16_t>(field::precision, 0);
      if (precision >= 0 && precision <= 2) place.bytes = std::size_t{2} << precision;
    }
    if (place.bytes == 0) refuse("column " + name, "is of another type", "numbers");
    return place;
  }

  // Whose buffer of offsets has four bytes a row.
  Place place_of_text(std::uint8_t kind, const std::string& name) const {
    if (kind != kTextType) refuse("column " + name, "is of another type", "texts");
    return {.kind = kind, .bytes = sizeof(std::int32_t)};
  }

  void read_batch(std::uint64_t offset, std::uint64_t metadata_size, std::uint64_t body_size) {
    const auto is_there = [&](std::uint64_t at, std::uint64_t count) {
      return at <= bytes_.size() && count <= bytes_.size() - at;
    };
    constexpr std::uint64_t head = 8;  // a continuation mark and the size
    if (metadata_size < head || !is_there(offset, metadata_size) ||
        !is_there(offset + metadata_size, body_size)) {
      refuse("record batch", fmt::format("reaches beyond byte {}", bytes_.size()), "all of it");
    }
    const bool is_marked = scalar<std::uint32_t>(offset) == 0xFFFFFFFF;
    const std::uint64_t skipped = is_marked ? head : head / 2;
    const FlatTable message =
        FlatTable::root(bytes_.substr(offset + skipped, metadata_size - skipped), name_);
    constexpr std::uint8_t record_batch = 3;
    const auto batch = message.table(field::header);
    if (message.number<std::uint8_t>(field::header_kind, 0) != record_batch || !batch) {
      refuse("record batch", "is another message", "a record batch");
    }
    body_ = bytes_.substr(offset + metadata_size, body_size);
    const auto rows = batch->number<std::uint64_t>(field::length, 0);
    for (std::size_t c = 0; c < columns_.size(); ++c) read_column(*batch, rows, c);
  }

  void read_column(const FlatTable& batch, std::uint64_t rows, std::size_t c) {
    const std::string element = "column " + columns_[c].name;
    const Place& place = places_[c];
    const std::uint32_t last_buffer = place.first_buffer + (place.kind == kTextType ? 2 : 1);
    if (batch.count(field::nodes, kPairSize) <= place.node ||
        batch.count(field::buffers, kPairSize) <= last_buffer) {
      refuse(element, "is missing in a record batch", "all columns");
    }
    if (batch.number_of<std::int64_t>(field::nodes, place.node, kPairSize, 8) != 0) {
      refuse(element, "has rows without a value", "one in each row");
    }
    // Of all batches: the footer may name one of them many times.
    const std::size_t row_bytes = place.kind == kTextType ? sizeof(std::string) : sizeof(double);
    if (rows > most_unpacked_of_rows(bytes_.size()) || !rows_left_.spend(rows * row_bytes)) {
      refuse(
          element,
          fmt::format("has {} rows, with those before too many for {} bytes", rows, bytes_.size()),
          "fewer");
    }
    if (place.kind == kTextType) return read_texts(batch, rows, c, element);
    const std::string_view values =
        buffer_of(batch, place.first_buffer + 1, rows * place.bytes, element);
    for (std::uint64_t row = 0; row < rows; ++row) {
      append(values.data() + row * place.bytes, place, columns_[c]);
    }
  }

  void read_texts(const FlatTable& batch, std::uint64_t rows, std::size_t c,
                  const std::string& element) {
    if (rows == 0) return;
    constexpr std::uint64_t step = sizeof(std::int32_t);
    const std::uint32_t buffer = places_[c].first_buffer + 1;
    const std::string offsets(buffer_of(batch, buffer, (rows + 1) * step, element));
    const auto offset = [&](std::uint64_t row) { return at<std::int32_t>(&offsets[row * step]); };
    const auto size = static_cast<std::uint64_t>(std::max(0, offset(rows)));
    if (!rows_left_.spend(size)) refuse(element, "has too many bytes", "fewer");
    const std::string_view texts = buffer_of(batch, buffer + 1, size, element);
    for (std::uint64_t row = 0; row < rows; ++row) {
      const std::int32_t from = offset(row), to = offset(row + 1);
      if (from < 0 || to < from || static_cast<std::uint64_t>(to) > size) {
        refuse(element, fmt::format("row {} is from byte {} to {}", row + 1, from, to),
               "texts one after the other");
      }
      columns_[c].texts.emplace_back(
          texts.substr(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from)));
    }
  }

  std::string_view buffer_of(const FlatTable& batch, std::uint32_t index, std::uint64_t size,
                             const std::string& element) {
    const auto at = batch.number_of<std::uint64_t>(field::buffers, index, kPairSize, 0);
    const auto length = batch.number_of<std::uint64_t>(field::buffers, index, kPairSize, 8);
    if (at > body_.size() || length > body_.size() - at) {
      refuse(element, "reaches beyond its record batch", "all of it");
    }
    std::string_view values = body_.substr(at, length);
    const auto compression = batch.table(field::compression);
    if (compression && !values.empty()) {
      constexpr std::size_t head = 8;
      if (values.size() < head) refuse(element, "is cut off", "the size of what is packed");
      std::int64_t unpacked_size = 0;
      std::memcpy(&unpacked_size, values.data(), head);
      values.remove_prefix(head);
      if (unpacked_size != -1) {  // -1: this one is not packed
        const auto codec = compression->number<std::uint8_t>(field::codec, 0);
        if (static_cast<std::uint64_t>(unpacked_size) < size || codec > 1 ||
            !unpacked_left_.spend(static_cast<std::uint64_t>(unpacked_size))) {
          refuse(element, fmt::format("unpacks to {} bytes", unpacked_size),
                 fmt::format("{} by LZ4 or Zstandard", size));
        }
        const std::string fault =
            unpack_block(values, codec == 0 ? BlockPacking::lz4 : BlockPacking::zstandard,
                         static_cast<std::uint64_t>(unpacked_size), unpacked_);
        if (!fault.empty()) refuse(element, "cannot be unpacked: " + fault, "whole data");
        values = unpacked_;
      }
    }
    if (values.size() < size) {
      refuse(element, fmt::format("has {} bytes", values.size()), fmt::format("{}", size));
    }
    return values;
  }

  template <class Number>
  static Number at(const char* bytes) {
    Number value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  template <class Signed, class Unsigned>
  static std::int64_t whole(const char* bytes, bool is_signed) {
    return is_signed ? static_cast<std::int64_t>(at<Signed>(bytes))
                     : static_cast<std::int64_t>(at<Unsigned>(bytes));
  }

  static void append(const char* bytes, const Place& place, FeatherColumn& column) {
    if (place.kind == kIntType) {
      const bool sign = place.is_signed;
      column.wholes.push_back(place.bytes == 1   ? whole<std::int8_t, std::uint8_t>(bytes, sign)
                              : place.bytes == 2 ? whole<std::int16_t, std::uint16_t>(bytes, sign)
                              : place.bytes == 4 ? whole<std::int32_t, std::uint32_t>(bytes, sign)
                                                 : whole<std::int64_t, std::uint64_t>(bytes, sign));
      return;
    }
    column.reals.push_back(place.bytes == 2   ? static_cast<double>(at<Eigen::half>(bytes))
                           : place.bytes == 4 ? static_cast<double>(at<float>(bytes))
                                              : at<double>(bytes));
  }

  std::string_view bytes_, body_;
  const std::string& name_;
  std::string unpacked_;
  geometry::WorkBudget unpacked_left_, rows_left_;  // bytes
  std::size_t numbers_ = 0;                         // of the columns; texts are behind them
  std::vector<FeatherColumn> columns_;
  std::vector<Place> places_;
};

}  // namespace

bool is_feather(std::string_view bytes) { return bytes.starts_with(kMagic); }

std::vector<FeatherColumn> parse_feather(std::string_view bytes, const std::string& name,
                                         const std::vector<std::string>& columns,
                                         const std::vector<std::string>& texts) {
  return FeatherReader(bytes, name).read(columns, texts);
}

}  // namespace roadbed::map::logs
