#include "roadbed/tools/support/trajectory_csv.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/read_file.h"

namespace roadbed::tools {
namespace {

using geometry::TrajectoryPoint;

struct Column {
  std::string_view name;
  double TrajectoryPoint::*value;
  bool required;
  double largest;  ///< magnitude that any real drive stays below
};

constexpr double kEarth_m = 1e9;
constexpr double kAnything = 1e12;
constexpr std::array<Column, 8> kColumns{{
    {"t_s", &TrajectoryPoint::t_s, true, kAnything},
    {"x_m", &TrajectoryPoint::x_m, true, kEarth_m},
    {"y_m", &TrajectoryPoint::y_m, true, kEarth_m},
    {"heading_rad", &TrajectoryPoint::heading_rad, true, kEarth_m},
    {"speed_mps", &TrajectoryPoint::speed_mps, false, kAnything},
    {"acceleration_mps2", &TrajectoryPoint::acceleration_mps2, false, kAnything},
    {"steering_rad", &TrajectoryPoint::steering_rad, false, kAnything},
    {"curvature_per_m", &TrajectoryPoint::curvature_per_m, false, kAnything},
}};

/// Where in which file, for messages.
struct Place {
  const std::string& file;
  std::size_t line;

  [[noreturn]] void refuse(std::string_view column, const std::string& found,
                           const std::string& needed, const std::string& remedy) const {
    throw map::InputError({.file = file,
                           .place = std::to_string(line),
                           .element = column.empty() ? "row" : fmt::format("column {}", column),
                           .found = found,
                           .needed = needed,
                           .remedy = remedy});
  }
};

std::string_view trim(std::string_view text) {
  constexpr std::string_view space = " \t\r";
  const std::size_t first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// Takes the next line off the text.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// Which field of a row holds which column.
struct Header {
  std::array<std::optional<std::size_t>, kColumns.size()> field_of;
  std::size_t fields = 0;
};

Header read_header(std::string_view line, const Place& place) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  const auto names = split(line);
  Header header{.field_of = {}, .fields = names.size()};
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    for (std::size_t f = 0; f < names.size(); ++f) {
      if (names[f] != kColumns[c].name) continue;
      if (header.field_of[c]) place.refuse(kColumns[c].name, "is there twice", "", "remove one");
      header.field_of[c] = f;
    }
    if (kColumns[c].required && !header.field_of[c]) {
      place.refuse(kColumns[c].name, "is missing from the header",
                   "a first line like t_s,x_m,y_m,heading_rad", "add or rename the column");
    }
  }
  return header;
}

double read_number(std::string_view text, const Column& column, const Place& place) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value) ||
      std::abs(value) > column.largest) {
    place.refuse(column.name, fmt::format("\"{}\"", text),
                 fmt::format("a number of magnitude up to {:g}", column.largest), "mend the row");
  }
  return value;
}

TrajectoryPoint read_row(std::string_view line, const Header& header, const Place& place) {
  const auto fields = split(line);
  if (fields.size() != header.fields) {
    place.refuse("", fmt::format("has {} fields", fields.size()),
                 fmt::format("{} as the header has", header.fields), "mend the row");
  }
  TrajectoryPoint point;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const auto field = header.field_of[c];
    if (field) point.*kColumns[c].value = read_number(fields[*field], kColumns[c], place);
  }
  return point;
}

}  // namespace

geometry::Trajectory parse_trajectory_csv(std::string_view bytes, const std::string& name) {
  Place place{name, 1};
  const Header header = read_header(next_line(bytes), place);
  std::vector<TrajectoryPoint> points;
  while (!bytes.empty()) {
    ++place.line;
    const std::string_view line = next_line(bytes);
    if (trim(line).empty()) continue;
    points.push_back(read_row(line, header, place));
    if (points.size() > 1 && !(points.back().t_s > points[points.size() - 2].t_s)) {
      place.refuse("t_s",
                   fmt::format("{} s does not come after {} s of the row before", points.back().t_s,
                               points[points.size() - 2].t_s),
                   "increasing times", "sort the rows and remove doubles");
    }
  }
  if (points.empty()) place.refuse("", "there is none", "at least one below the header", "add it");
  return geometry::Trajectory(std::move(points));
}

geometry::Trajectory read_trajectory_csv(const std::filesystem::path& file) {
  return parse_trajectory_csv(map::read_file(file), file.string());
}

std::string write_trajectory_csv(const geometry::Trajectory& drive) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    fmt::format_to(out, "{}{}", c == 0 ? "" : ",", kColumns[c].name);
  }
  for (const TrajectoryPoint& point : drive.points()) {
    fmt::format_to(out, "\n");
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
      fmt::format_to(out, "{}{}", c == 0 ? "" : ",", point.*kColumns[c].value);
    }
  }
  fmt::format_to(out, "\n");
  return fmt::to_string(text);
}

}  // namespace roadbed::tools
