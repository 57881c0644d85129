// PCD 0.5 to 0.7: https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr std::size_t kLongestPoint = 1 << 20;

struct Field {
  std::string name;  // lower case
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
  std::size_t first_element = 0;  // before it in an ascii line
  std::size_t offset = 0;         // before it in a binary point
  ScalarType scalar = ScalarType::f32;
};

struct Header {
  std::string version = "0.7";
  std::vector<Field> fields;
  std::optional<std::uint64_t> width, height, points;
  std::string data;
  std::size_t point_size = 0;      // bytes
  std::size_t point_elements = 0;  // words of an ascii line
  std::string_view body;
  std::size_t body_offset = 0;
  std::size_t lines = 0;
};

// The fields of a vector.
using Axes = std::array<const Field*, 3>;

/// Undoes LZF; none unless the bytes are whole and give exactly `size` bytes.
std::optional<std::string> decompress_lzf(std::string_view packed, std::size_t size) {
  // A reference of 3 bytes copies at most 264: a size that cannot be reached is not allocated.
  constexpr std::size_t kMostPerByte = 88;
  if (packed.empty() || size / kMostPerByte > packed.size()) return std::nullopt;
  std::string plain(size, '\0');
  const unsigned written = lzf_decompress(packed.data(), static_cast<unsigned>(packed.size()),
                                          plain.data(), static_cast<unsigned>(size));
  if (written == 0 || written != size) return std::nullopt;  // it says 0 where it failed
  return plain;
}

class PcdParser {
 public:
  PcdParser(std::string_view bytes, const std::string& name, const CloudFilter& filter)
      : bytes_(bytes), name_(name), asked_(filter) {}

  RawCloud parse() {
    read_header();
    check_points();
    lay_out_fields();
    cloud_.format = fmt::format("PCD {} {}", header_.version, header_.data);
    if (header_.data == "ascii") {
      read_ascii();
    } else if (header_.data == "binary") {
      read_binary();
    } else if (header_.data == "binary_compressed") {
      read_compressed();
    } else {
      refuse("DATA", fmt::format("\"{}\"", header_.data), "ascii, binary or binary_compressed",
             "save the cloud again");
    }
    return std::move(cloud_);
  }

 private:
  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed, const std::string& remedy) const {
    refuse_cloud(name_, std::to_string(header_.lines), element, found, needed, remedy);
  }

  void read_header() {
    TextScanner lines(bytes_);
    while (header_.data.empty()) {
      if (lines.done()) {
        refuse("header", "ends without a DATA line", "a whole PCD header",
               "check that the file is whole");
      }
      const std::string_view line = lines.next_line();
      header_.lines = lines.line_number();
      read_header_line(line);
    }
    header_.body = lines.rest();
    header_.body_offset = bytes_.size() - header_.body.size();
  }

  void read_header_line(std::string_view line) {
    const std::string key = lower(next_word(line));
    if (key.empty() || key.starts_with('#')) return;
    if (key == "version") {
      header_.version = next_word(line).substr(0, 8);
    } else if (key == "fields" || key == "columns") {
      read_fields(line);
    } else if (key == "size" || key == "count" || key == "type") {
      for (Field& field : header_.fields) read_property(field, key, next_word(line));
    } else if (key == "width") {
      header_.width = count(key, next_word(line));
    } else if (key == "height") {
      header_.height = count(key, next_word(line));
    } else if (key == "points") {
      header_.points = count(key, next_word(line));
    } else if (key == "viewpoint") {
      read_viewpoint(line);
    } else if (key == "data") {
      header_.data = lower(next_word(line));
      if (header_.data.empty()) refuse("DATA", "has no value", "ascii or binary", "mend the line");
    } else {
      refuse("header", fmt::format("unknown word \"{}\"", key.substr(0, 40)),
             "a PCD header line such as FIELDS x y z", "check that the file is a PCD file");
    }
  }

  void read_fields(std::string_view line) {
    header_.fields.clear();
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      header_.fields.push_back({.name = lower(word)});
    }
  }

  void read_property(Field& field, const std::string& key, std::string_view word) {
    if (word.empty()) {
      refuse(lower(key), "has fewer values than FIELDS", "one value per field", "mend the line");
    }
    if (key == "type") {
      field.type = static_cast<char>(word.front() & ~0x20);  // upper case
    } else if (key == "size") {
      field.size = count(key, word);
    } else {
      field.count = count(key, word);
    }
  }

  std::size_t count(const std::string& key, std::string_view word) const {
    const auto value = parse_count(word);
    if (!value || *value > (std::uint64_t{1} << 40)) {
      refuse(key, fmt::format("\"{}\"", word), "a whole number from 0 to 2^40", "mend the header");
    }
    return *value;
  }

  // A viewpoint left at its default says nothing about where the sensor was; with a rotation it is
  // not told whether the points are in the sensor's frame.
  void read_viewpoint(std::string_view line) {
    std::array<double, 7> values{};
    for (double& value : values) {
      const auto number = parse_number(next_word(line));
      if (!number || !std::isfinite(*number)) return;
      value = *number;
    }
    const Eigen::Vector3d at(values[0], values[1], values[2]);
    const bool turned = values[4] != 0.0 || values[5] != 0.0 || values[6] != 0.0;
    if (turned) {
      cloud_.notes.emplace_back("its viewpoint has a rotation and is not taken as the sensor");
    } else if (!at.isZero(0.0)) {
      cloud_.sensor_in_source = at;
    }
  }

  void check_points() {
    if (!header_.width && !header_.points) {
      refuse("header", "says no number of points", "WIDTH and HEIGHT, or POINTS",
             "check that the header is whole");
    }
    if (!header_.width) return;
    const std::uint64_t height = header_.height.value_or(1);
    // Both are at most 2^40: the product of larger ones could wrap.
    if (height != 0 && *header_.width > (std::uint64_t{1} << 40) / height) {
      refuse("WIDTH and HEIGHT", fmt::format("{} times {}", *header_.width, height),
             "at most 2^40 points", "mend the header");
    }
    const std::uint64_t product = *header_.width * height;
    if (header_.points && *header_.points != product) {
      refuse("POINTS", fmt::format("{}", *header_.points),
             fmt::format("{}, which is WIDTH times HEIGHT", product), "mend the header");
    }
    header_.points = product;
  }

  void lay_out_fields() {
    for (Field& field : header_.fields) {
      field.first_element = header_.point_elements;
      field.offset = header_.point_size;
      field.scalar = scalar_of(field);
      if (field.count > kLongestPoint || header_.point_size > kLongestPoint) {
        refuse("COUNT", fmt::format("{} of field {}", field.count, field.name),
               fmt::format("points of at most {} bytes", kLongestPoint), "mend the header");
      }
      header_.point_elements += field.count;
      header_.point_size += field.size * field.count;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      axes_[axis] = &field_of(name);
      if (axes_[axis]->count == 1) continue;
      refuse("COUNT", fmt::format("{} of field {}", axes_[axis]->count, name), "1",
             "mend the header");
    }
    find_sensor();
  }

  void find_sensor() {
    std::vector<std::string> names;
    for (const Field& field : header_.fields) {
      names.push_back(field.count == 1 ? field.name : std::string());
    }
    filter_ = AttributeFilter(asked_, names, name_);
    const auto columns = sensor_columns(names, cloud_.notes);
    if (!columns) return;
    sensor_.emplace();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (*sensor_)[axis] = &header_.fields[(*columns)[axis]];
    }
  }

  // Takes a point whose fields are `value(field)`.
  template <typename Value>
  void add_point(const Value& value) {
    if (!filter_.keeps([&](std::size_t i) { return value(header_.fields[i]); })) {
      ++cloud_.filtered_out;
      return;
    }
    const auto vector_of = [&](const Axes& axes) {
      return Eigen::Vector3d(value(*axes[0]), value(*axes[1]), value(*axes[2]));
    };
    if (sensor_) {
      cloud_.add(vector_of(axes_), vector_of(*sensor_));
    } else {
      cloud_.add(vector_of(axes_));
    }
  }

  ScalarType scalar_of(const Field& field) const {
    using enum ScalarType;
    if (field.type == 'F' && field.size == 4) return f32;
    if (field.type == 'F' && field.size == 8) return f64;
    const bool is_signed = field.type == 'I';
    if (is_signed || field.type == 'U') {
      if (field.size == 1) return is_signed ? i8 : u8;
      if (field.size == 2) return is_signed ? i16 : u16;
      if (field.size == 4) return is_signed ? i32 : u32;
      if (field.size == 8) return is_signed ? i64 : u64;
    }
    refuse("TYPE and SIZE", fmt::format("{} {} of field {}", field.type, field.size, field.name),
           "F 4, F 8, or I or U with 1, 2, 4 or 8", "mend the header");
  }

  const Field& field_of(const std::string& axis) const {
    for (const Field& field : header_.fields) {
      if (field.name == axis) return field;
    }
    refuse("FIELDS", fmt::format("has no field {}", axis), "x, y and z", "check the cloud's type");
  }

  // Every point takes at least `least_size` bytes of the body, so a wild count allocates nothing.
  void check_body(std::uint64_t least_size, std::size_t body_size) const {
    if (least_size != 0 && *header_.points > body_size / least_size) {
      refuse("POINTS",
             fmt::format("{} points do not fit in the {} bytes that follow", *header_.points,
                         body_size),
             fmt::format("{} bytes or more", least_size), "get the whole file, or mend the header");
    }
  }

  void read_ascii() {
    check_body(2 * header_.point_elements - 1, header_.body.size() + 1);
    TextScanner lines(header_.body);
    std::uint64_t read = 0;
    while (read < *header_.points && !lines.done()) {
      std::string_view line = lines.next_line();
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      add_ascii_point(line, header_.lines + lines.line_number());
      ++read;
    }
    if (read < *header_.points) {
      refuse("POINTS", fmt::format("{}, but only {} lines follow", *header_.points, read),
             "a line per point", "get the whole file, or mend the header");
    }
    note_trailing(lines.rest().size());
  }

  void add_ascii_point(std::string_view line, std::size_t number) {
    words_.clear();
    while (words_.size() < header_.point_elements) {
      const std::string_view word = next_word(line);
      if (word.empty()) {
        refuse_cloud(
            name_, std::to_string(number), "point", fmt::format("has {} values", words_.size()),
            fmt::format("{} as FIELDS and COUNT say", header_.point_elements), "mend the line");
      }
      words_.push_back(word);
    }
    add_point([&](const Field& field) {
      const std::string_view word = words_[field.first_element];
      if (const auto value = parse_number(word)) return *value;
      refuse_cloud(name_, std::to_string(number), "point",
                   fmt::format("\"{}\" is not a number", word.substr(0, 40)), "", "mend the line");
    });
  }

  void read_binary() {
    check_body(header_.point_size, header_.body.size());
    const bool are_floats = std::ranges::all_of(
        axes_, [](const Field* axis) { return axis->scalar == ScalarType::f32; });
    if (are_floats && !sensor_ && filter_.keeps_all() &&
        std::endian::native == std::endian::little) {
      add_float_points({.first = header_.body.data(),
                        .count = *header_.points,
                        .size = header_.point_size,
                        .x_offset = axes_[0]->offset,
                        .y_offset = axes_[1]->offset,
                        .z_offset = axes_[2]->offset},
                       cloud_);
    } else {
      read_scalars();
    }
    note_trailing(header_.body.size() - *header_.points * header_.point_size);
  }

  void read_scalars() {
    cloud_.points_in_source.reserve(*header_.points);
    for (std::uint64_t i = 0; i < *header_.points; ++i) {
      const char* point = header_.body.data() + i * header_.point_size;
      add_point([&](const Field& f) { return read_scalar(point + f.offset, f.scalar); });
    }
  }

  // Sizes of the compressed and the plain body, then LZF of all x, then all y, and so on.
  void read_compressed() {
    if (header_.body.size() < 8) {
      refuse("DATA", "ends before its sizes", "8 bytes", "get the whole file");
    }
    const std::uint64_t packed = read_unsigned(header_.body, 0, 4);
    const std::uint64_t plain = read_unsigned(header_.body, 4, 4);
    if (packed > header_.body.size() - 8) {
      refuse("DATA", fmt::format("{} of {} compressed bytes", header_.body.size() - 8, packed),
             "all of them", "get the whole file");
    }
    if (*header_.points > plain / header_.point_size ||
        *header_.points * header_.point_size != plain) {
      refuse("DATA", fmt::format("{} bytes when uncompressed", plain),
             fmt::format("{} points of {} bytes", *header_.points, header_.point_size),
             "save the cloud again");
    }
    check_unfolded(plain);
    const auto body = decompress_lzf(header_.body.substr(8, packed), plain);
    if (!body) {
      refuse("DATA", "cannot be uncompressed to the size that it names", "LZF",
             "get the file again");
    }
    read_columns(*body);
    note_trailing(header_.body.size() - 8 - packed);
  }

  // What unfolds to ninety times its size is no scan.
  void check_unfolded(std::uint64_t plain) const {
    constexpr std::uint64_t point_bytes = 3 * sizeof(double);
    const std::uint64_t taken = plain + *header_.points * (sensor_ ? 2 : 1) * point_bytes;
    const std::uint64_t most = geometry::most_bytes(bytes_.size()) - bytes_.size();
    if (taken <= most) return;
    refuse("DATA",
           fmt::format("{} MB of points in {} MB", plain / 1'000'000, bytes_.size() / 1'000'000),
           fmt::format("points that take at most {} MB of memory", most / 1'000'000),
           "save the cloud in parts, or uncompressed");
  }

  void read_columns(const std::string& body) {
    const std::uint64_t points = *header_.points;
    cloud_.points_in_source.reserve(points);
    for (std::uint64_t i = 0; i < points; ++i) {
      add_point([&](const Field& f) {
        return read_scalar(body.data() + f.offset * points + i * f.size, f.scalar);
      });
    }
  }

  void note_trailing(std::size_t size) {
    if (size > 2) {
      cloud_.notes.push_back(fmt::format("{} bytes after the last point are ignored", size));
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  const CloudFilter& asked_;
  AttributeFilter filter_;
  Header header_;
  Axes axes_{};
  std::optional<Axes> sensor_;           // where the file has its position for each point
  std::vector<std::string_view> words_;  // of a point in ascii
  RawCloud cloud_;
};

}  // namespace

RawCloud parse_pcd(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  return PcdParser(bytes, name, filter).parse();
}

}  // namespace roadbed::map::occupancy::clouds
