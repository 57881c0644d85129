// Text with a point per line: x, y, z first, or in the columns that a header line names so; it may
// name columns of the sensor as well.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

std::vector<std::string_view> split(std::string_view line) {
  constexpr std::string_view space = " \t", separators = ",;";
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(space);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t,;", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
    line.remove_prefix(std::min(line.find_first_not_of(space), line.size()));
    if (!line.empty() && separators.find(line.front()) != std::string_view::npos) {
      line.remove_prefix(1);
    }
  }
}

// "//X", "x_m" and "\"x\"" all name the x axis.
std::string axis_of(std::string_view word) {
  std::string small = lower(word);
  std::erase_if(small, [](char c) { return c == '"' || c == '/' || c == '#'; });
  if (small.ends_with("_m")) small.resize(small.size() - 2);
  return small;
}

std::vector<std::string> field_names(const std::vector<std::string_view>& words) {
  std::vector<std::string> names;
  for (const std::string_view word : words) names.push_back(axis_of(word));
  return names;
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

class XyzParser {
 public:
  XyzParser(std::string_view bytes, const std::string& name, const CloudFilter& filter)
      : lines_(bytes), name_(name), asked_(filter) {
    constexpr std::size_t least_bytes = 6;  // of a point: "0 0 0\n"
    const auto lines = static_cast<std::size_t>(std::ranges::count(bytes, '\n')) + 1;
    cloud_.points_in_source.reserve(std::min(lines, bytes.size() / least_bytes + 1));
  }

  RawCloud parse() {
    cloud_.format = "XYZ text";
    while (!lines_.done()) {
      const std::string_view line = lines_.next_line();
      const auto words = split(line);
      if (words.empty() || take_header(line, words)) continue;
      if (is_before_points()) {
        filter_ = AttributeFilter(asked_, names_, name_);
      }
      if (!filter_.keeps([&](std::size_t column) { return number(words, column, "a number"); })) {
        ++cloud_.filtered_out;
        continue;
      }
      const Eigen::Vector3d point = numbers(words, columns_, "x, y and z");
      if (sensor_columns_) {
        cloud_.add(point, numbers(words, *sensor_columns_, "the sensor's x, y and z"));
      } else {
        cloud_.add(point);
      }
    }
    return std::move(cloud_);
  }

 private:
  bool is_before_points() const {
    return cloud_.empty() && cloud_.dropped_not_finite == 0 && cloud_.filtered_out == 0;
  }

  // Comments anywhere; column names or a number of points before the first point.
  bool take_header(std::string_view line, const std::vector<std::string_view>& words) {
    const bool before_points = is_before_points();
    const bool is_named = before_points && take_names(field_names(words));
    if (is_named || is_comment(line)) return true;
    return before_points && words.size() == 1 && parse_count(words[0]).has_value();
  }

  bool take_names(const std::vector<std::string>& names) {
    const auto named = columns_named(names, {"x", "y", "z"});
    if (!named) return false;
    columns_ = *named;
    names_ = names;
    sensor_columns_ = sensor_columns(names, cloud_.notes);
    return true;
  }

  Eigen::Vector3d numbers(const std::vector<std::string_view>& words, const FieldColumns& columns,
                          const char* needed) const {
    Eigen::Vector3d numbers;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      numbers[static_cast<int>(axis)] = number(words, columns[axis], needed);
    }
    return numbers;
  }

  double number(const std::vector<std::string_view>& words, std::size_t column,
                const char* needed) const {
    if (column >= words.size()) refuse(fmt::format("has {} values", words.size()), needed);
    const auto value = parse_number(words[column]);
    if (!value) refuse(fmt::format("\"{}\" is not a number", words[column].substr(0, 40)), needed);
    return *value;
  }

  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    refuse_cloud(name_, std::to_string(lines_.line_number()), "point", found, needed,
                 "mend the line, or check that the file is text");
  }

  TextScanner lines_;
  const std::string& name_;
  const CloudFilter& asked_;
  AttributeFilter filter_;
  std::vector<std::string> names_;  // of the columns, where a line says them
  FieldColumns columns_{0, 1, 2};
  std::optional<FieldColumns> sensor_columns_;
  RawCloud cloud_;
};

}  // namespace

bool begins_as_xyz(std::string_view bytes) {
  TextScanner lines(bytes.substr(0, 4096));
  while (!lines.done()) {
    const std::string_view line = lines.next_line();
    const auto words = split(line);
    if (words.empty()) continue;
    if (columns_named(field_names(words), {"x", "y", "z"})) return true;
    if (is_comment(line) || (words.size() == 1 && parse_count(words[0]))) continue;
    return words.size() >= 3 && std::all_of(words.begin(), words.begin() + 3, parse_number);
  }
  return false;
}

RawCloud parse_xyz(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
  return XyzParser(bytes, name, filter).parse();
}

}  // namespace roadbed::map::occupancy::clouds
