#include "roadbed/map/occupancy/clouds/cloud_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline clouds {

void RawCloud::add(const Eigen::Vector3d& point) {
  // A comparison with NaN is false, so NaN is dropped too.
  if (point.cwiseAbs().maxCoeff() < kBeyondEarth && point.allFinite()) {
    points_in_source.push_back(point);
  } else {
    ++dropped_not_finite;
  }
}

void RawCloud::add(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor) {
  const std::size_t kept = points_in_source.size();
  add(point);
  if (points_in_source.size() == kept) return;
  std::optional<Eigen::Vector3d> from;
  if (sensor.allFinite() && sensor.cwiseAbs().maxCoeff() < kBeyondEarth) from = sensor;
  if (!from) ++without_sensor;
  if (scans.empty() || scans.back().sensor_in_source != from) scans.push_back({kept, from});
}

std::optional<FieldColumns> columns_named(const std::vector<std::string>& fields,
                                          const std::array<std::string_view, 3>& names) {
  FieldColumns columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = std::ranges::find(fields, names[axis]);
    if (found == fields.end()) return std::nullopt;
    columns[axis] = static_cast<std::size_t>(found - fields.begin());
  }
  return columns;
}

std::optional<FieldColumns> sensor_columns(const std::vector<std::string>& fields,
                                           std::vector<std::string>& notes) {
  static constexpr std::array<std::array<std::string_view, 3>, 4> usual{
      {{"sensor_x", "sensor_y", "sensor_z"},
       {"vp_x", "vp_y", "vp_z"},
       {"x_origin", "y_origin", "z_origin"},
       {"beamoriginx", "beamoriginy", "beamoriginz"}}};
  for (const auto& names : usual) {
    if (const auto columns = columns_named(fields, names)) return columns;
    const auto some = std::ranges::find_first_of(fields, names);
    if (some == fields.end()) continue;
    notes.push_back(fmt::format("has {}, but not all of {}, {} and {}: not taken as the sensor",
                                *some, names[0], names[1], names[2]));
  }
  return std::nullopt;
}

void refuse_cloud(const std::string& file, const std::string& place, const std::string& element,
                  const std::string& found, const std::string& needed, const std::string& remedy) {
  throw InputError({.file = file,
                    .place = place,
                    .element = element,
                    .found = found,
                    .needed = needed,
                    .remedy = remedy});
}

std::size_t size_of(ScalarType type) {
  switch (type) {
    case ScalarType::i8:
    case ScalarType::u8:
      return 1;
    case ScalarType::i16:
    case ScalarType::u16:
      return 2;
    case ScalarType::i32:
    case ScalarType::u32:
    case ScalarType::f32:
      return 4;
    default:
      return 8;
  }
}

namespace {

template <typename Number>
double value_of(std::uint64_t bits) {
  if constexpr (std::is_same_v<Number, float>) {
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  } else if constexpr (std::is_same_v<Number, double>) {
    return std::bit_cast<double>(bits);
  } else {
    return static_cast<double>(static_cast<Number>(bits));
  }
}

std::uint64_t gather(const char* bytes, std::size_t size, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t shift = 8 * (big_endian ? size - 1 - i : i);
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << shift;
  }
  return bits;
}

}  // namespace

double read_scalar(const char* bytes, ScalarType type, bool big_endian) {
  const std::uint64_t bits = gather(bytes, size_of(type), big_endian);
  switch (type) {
    case ScalarType::i8:
      return value_of<std::int8_t>(bits);
    case ScalarType::u8:
      return value_of<std::uint8_t>(bits);
    case ScalarType::i16:
      return value_of<std::int16_t>(bits);
    case ScalarType::u16:
      return value_of<std::uint16_t>(bits);
    case ScalarType::i32:
      return value_of<std::int32_t>(bits);
    case ScalarType::u32:
      return value_of<std::uint32_t>(bits);
    case ScalarType::i64:
      return value_of<std::int64_t>(bits);
    case ScalarType::u64:
      return value_of<std::uint64_t>(bits);
    case ScalarType::f32:
      return value_of<float>(bits);
    case ScalarType::f64:
      return value_of<double>(bits);
  }
  return 0.0;
}

std::uint64_t read_unsigned(std::string_view bytes, std::size_t offset, std::size_t size) {
  if (offset > bytes.size() || bytes.size() - offset < size) {
    throw std::out_of_range("read_unsigned: the bytes end before the number");
  }
  return gather(bytes.data() + offset, size, false);
}

std::string_view TextScanner::next_line() {
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_;
  return line;
}

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view space = " \t\r";
  const std::size_t begin = std::min(line.find_first_not_of(space), line.size());
  const std::size_t end = std::min(line.find_first_of(space, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
  return value;
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || error != std::errc()) return std::nullopt;
  return value;
}

std::string lower(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return small;
}

}  // namespace roadbed::map::occupancy::clouds
