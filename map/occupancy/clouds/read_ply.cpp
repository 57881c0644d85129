// PLY 1.0: Greg Turk, "The PLY Polygon File Format", 1994.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

struct Property {
  std::string name;  // lower case
  ScalarType type = ScalarType::f32;
  std::optional<ScalarType> list_count;  // of a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  // Bytes that a row takes at least; a list takes at least its length.
  std::size_t least_row_bytes() const {
    std::size_t bytes = 0;
    for (const Property& p : properties) bytes += size_of(p.list_count.value_or(p.type));
    return bytes;
  }
};

std::optional<ScalarType> scalar_named(std::string_view word) {
  using enum ScalarType;
  struct Entry {
    std::string_view name;
    ScalarType type;
  };
  static constexpr Entry entries[] = {
      {"char", i8},   {"int8", i8},     {"uchar", u8},   {"uint8", u8},
      {"short", i16}, {"int16", i16},   {"ushort", u16}, {"uint16", u16},
      {"int", i32},   {"int32", i32},   {"uint", u32},   {"uint32", u32},
      {"float", f32}, {"float32", f32}, {"double", f64}, {"float64", f64},
  };
  for (const Entry& entry : entries) {
    if (entry.name == word) return entry.type;
  }
  return std::nullopt;
}

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name, const CloudFilter& filter)
      : lines_(bytes), name_(name), asked_(filter) {}

  RawCloud parse() {
    read_header();
    body_ = lines_.rest();
    for (const Element& element : elements_) {
      check_rows(element);
      if (element.name == "vertex") {
        read_vertices(element);
        return std::move(cloud_);
      }
      skip(element);
    }
    refuse("header", "has no element vertex", "element vertex with x, y and z",
           "check that it is a point cloud");
  }

 private:
  enum class Encoding { unknown, ascii, little_endian, big_endian };

  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed, const std::string& remedy) const {
    refuse_cloud(name_, std::to_string(lines_.line_number()), element, found, needed, remedy);
  }

  void read_header() {
    lines_.next_line();  // "ply"
    while (true) {
      if (lines_.done()) {
        refuse("header", "ends without end_header", "a whole PLY header",
               "check that the file is whole");
      }
      std::string_view line = lines_.next_line();
      const std::string_view key = next_word(line);
      if (key == "end_header") break;
      read_header_line(key, line);
    }
    if (encoding_ == Encoding::unknown) {
      refuse("header", "has no format line", "format ascii 1.0 or format binary_little_endian 1.0",
             "save the cloud again");
    }
  }

  void read_header_line(std::string_view key, std::string_view line) {
    if (key == "format") {
      read_encoding(next_word(line));
    } else if (key == "element") {
      read_element(line);
    } else if (key == "property") {
      read_property(line);
    } else if (key != "comment" && key != "obj_info" && !key.empty()) {
      refuse("header", fmt::format("unknown word \"{}\"", key.substr(0, 40)),
             "format, element, property, comment or end_header", "mend the header");
    }
  }

  void read_encoding(std::string_view word) {
    if (word == "ascii") {
      encoding_ = Encoding::ascii;
    } else if (word == "binary_little_endian") {
      encoding_ = Encoding::little_endian;
    } else if (word == "binary_big_endian") {
      encoding_ = Encoding::big_endian;
    } else {
      refuse("format", fmt::format("\"{}\"", word.substr(0, 40)),
             "ascii, binary_little_endian or binary_big_endian", "save the cloud again");
    }
    cloud_.format = fmt::format("PLY 1.0 {}", word);
  }

  void read_element(std::string_view line) {
    const std::string_view name = next_word(line);
    const auto count = parse_count(next_word(line));
    if (name.empty() || !count || *count > (std::uint64_t{1} << 40)) {
      refuse("element", "has no name or no count", "a name and a count up to 2^40",
             "mend the header");
    }
    elements_.push_back({.name = std::string(name), .count = *count, .properties = {}});
  }

  void read_property(std::string_view line) {
    if (elements_.empty()) {
      refuse("property", "comes before any element", "an element line", "mend the header");
    }
    Property property;
    std::string_view type = next_word(line);
    if (type == "list") {
      property.list_count = scalar(next_word(line));
      type = next_word(line);
    }
    property.type = scalar(type);
    property.name = lower(next_word(line));
    elements_.back().properties.push_back(std::move(property));
  }

  ScalarType scalar(std::string_view word) const {
    const auto type = scalar_named(word);
    if (!type) {
      refuse("property", fmt::format("unknown type \"{}\"", word.substr(0, 40)),
             "one of char, uchar, short, ushort, int, uint, float, double", "mend the header");
    }
    return *type;
  }

  // Every row takes some bytes of the body, so a wild count allocates nothing and loops for long
  // over nothing.
  void check_rows(const Element& element) const {
    const std::size_t row =
        encoding_ == Encoding::ascii ? 2 * element.properties.size() : element.least_row_bytes();
    if (row != 0 && element.count > (body_.size() + 1) / row) {
      refuse(fmt::format("element {}", element.name),
             fmt::format("{} rows do not fit in the {} bytes that follow", element.count,
                         body_.size()),
             fmt::format("{} bytes or more a row", row), "get the whole file, or mend the header");
    }
  }

  void skip(const Element& element) {
    if (element.properties.empty()) return;
    std::vector<double> values;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, i, values);
  }

  void read_vertices(const Element& element) {
    std::vector<std::string> names;
    for (const Property& p : element.properties) {
      names.push_back(p.list_count ? std::string() : p.name);
    }
    const FieldColumns axes = axes_of(names);
    filter_ = AttributeFilter(asked_, names, name_);
    const std::optional<FieldColumns> sensor = sensor_columns(names, cloud_.notes);
    cloud_.points_in_source.reserve(element.count);
    std::vector<double> values;
    const auto vector_at = [&](const FieldColumns& columns) {
      return Eigen::Vector3d(values[columns[0]], values[columns[1]], values[columns[2]]);
    };
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, i, values);
      if (!filter_.keeps([&](std::size_t k) { return values[k]; })) {
        ++cloud_.filtered_out;
      } else if (sensor) {
        cloud_.add(vector_at(axes), vector_at(*sensor));
      } else {
        cloud_.add(vector_at(axes));
      }
    }
  }

  FieldColumns axes_of(const std::vector<std::string>& names) const {
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    if (const auto columns = columns_named(names, axes)) return *columns;
    const auto missing = std::ranges::find_if(
        axes, [&](std::string_view axis) { return std::ranges::find(names, axis) == names.end(); });
    refuse("element vertex", fmt::format("has no property {}", *missing), "x, y and z",
           "check that it is a point cloud");
  }

  // Values of one row, a list's as the number of its entries.
  void read_row(const Element& element, std::uint64_t row, std::vector<double>& values) {
    values.clear();
    if (encoding_ == Encoding::ascii) line_ = next_filled_line();
    for (const Property& property : element.properties) {
      const double value = next_value(element, row, property.list_count.value_or(property.type));
      values.push_back(value);
      if (property.list_count) skip_list(element, row, property, value);
    }
  }

  std::string_view next_filled_line() {
    while (!lines_.done()) {
      const std::string_view line = lines_.next_line();
      if (line.find_first_not_of(" \t\r") != std::string_view::npos) return line;
    }
    return {};
  }

  double next_value(const Element& element, std::uint64_t row, ScalarType type) {
    if (encoding_ == Encoding::ascii) {
      const std::string_view word = next_word(line_);
      if (const auto value = parse_number(word)) return *value;
      refuse(
          fmt::format("element {}, row {}", element.name, row),
          word.empty() ? "ends early" : fmt::format("\"{}\" is not a number", word.substr(0, 40)),
          fmt::format("{} values", element.properties.size()), "mend the row");
    }
    if (body_.size() < size_of(type)) refuse_end(element, row);
    const double value = read_scalar(body_.data(), type, encoding_ == Encoding::big_endian);
    body_.remove_prefix(size_of(type));
    return value;
  }

  void skip_list(const Element& element, std::uint64_t row, const Property& list, double length) {
    if (!(length >= 0.0 && length <= static_cast<double>(body_.size()))) refuse_end(element, row);
    const auto entries = static_cast<std::uint64_t>(length);
    if (encoding_ == Encoding::ascii) {
      for (std::uint64_t i = 0; i < entries; ++i) next_value(element, row, list.type);
      return;
    }
    if (entries * size_of(list.type) > body_.size()) refuse_end(element, row);
    body_.remove_prefix(entries * size_of(list.type));
  }

  [[noreturn]] void refuse_end(const Element& element, std::uint64_t row) const {
    refuse(fmt::format("element {}, row {}", element.name, row), "the file ends in it",
           fmt::format("{} rows", element.count), "get the whole file, or mend the header");
  }

  TextScanner lines_;
  const std::string& name_;
  const CloudFilter& asked_;
  AttributeFilter filter_;
  Encoding encoding_ = Encoding::unknown;
  std::vector<Element> elements_;
  std::string_view body_;  // what is left of a binary body
  std::string_view line_;  // what is left of the row of an ascii body
  RawCloud cloud_;
};

}  // namespace

RawCloud parse_ply(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  return PlyParser(bytes, name, filter).parse();
}

}  // namespace roadbed::map::occupancy::clouds
