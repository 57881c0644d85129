#include "roadbed/tools/support/points_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>

#include "roadbed/map/input_error.h"
#include "roadbed/map/read_file.h"

namespace roadbed::tools {
namespace {

constexpr double kEarth_m = 1e9;

/// Where in which file, for messages.
struct Line {
  const std::string& file;
  std::size_t number;

  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed) const {
    throw map::InputError({.file = file,
                           .place = std::to_string(number),
                           .element = element,
                           .found = found,
                           .needed = needed,
                           .remedy = "mend the row"});
  }
};

std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::string_view kSpace = " \t\r";
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    field.remove_prefix(std::min(field.find_first_not_of(kSpace), field.size()));
    fields.push_back(field.substr(0, field.find_last_not_of(kSpace) + 1));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

std::size_t column(const std::vector<std::string_view>& names,
                   std::initializer_list<std::string_view> accepted, const Line& line) {
  for (const std::string_view name : accepted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  }
  line.refuse(fmt::format("column {}", *accepted.begin()), "is missing from the header",
              "a first line like x_m,y_m");
}

double number(const std::vector<std::string_view>& fields, std::size_t at, const Line& line) {
  const std::string_view text = at < fields.size() ? fields[at] : std::string_view();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !(std::abs(value) <= kEarth_m)) {
    line.refuse(fmt::format("field {}", at + 1), fmt::format("\"{}\"", text),
                fmt::format("a number of magnitude up to {:g}", kEarth_m));
  }
  return value;
}

}  // namespace

std::vector<Eigen::Vector2d> parse_points_csv(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  Line line{name, 1};
  const auto header = fields_of(take_line(bytes));
  const std::size_t x = column(header, {"x_m", "x"}, line), y = column(header, {"y_m", "y"}, line);
  std::vector<Eigen::Vector2d> points;
  while (!bytes.empty()) {
    ++line.number;
    const auto fields = fields_of(take_line(bytes));
    if (fields.size() == 1 && fields[0].empty()) continue;
    points.emplace_back(number(fields, x, line), number(fields, y, line));
  }
  if (points.empty()) line.refuse("rows", "there is none", "at least one below the header");
  return points;
}

std::vector<Eigen::Vector2d> read_points_csv(const std::filesystem::path& file) {
  return parse_points_csv(map::read_file(file), file.string());
}

}  // namespace roadbed::tools
