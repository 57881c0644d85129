#include "roadbed/tools/files/trajectory_csv.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/csv.h"
#include "roadbed/tools/files/drive_plausibility.h"

namespace roadbed::tools::inline files {
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
constexpr std::array<Column, 8> kTrajectoryColumns{{
    {"t_s", &TrajectoryPoint::t_s, true, kAnything},
    {"x_m", &TrajectoryPoint::x_m, true, kEarth_m},
    {"y_m", &TrajectoryPoint::y_m, true, kEarth_m},
    {"heading_rad", &TrajectoryPoint::heading_rad, true, kEarth_m},
    {"speed_mps", &TrajectoryPoint::speed_mps, false, kAnything},
    {"acceleration_mps2", &TrajectoryPoint::acceleration_mps2, false, kAnything},
    {"steering_rad", &TrajectoryPoint::steering_rad, false, kAnything},
    {"curvature_per_m", &TrajectoryPoint::curvature_per_m, false, kAnything},
}};

/// Which field of a row holds which column.
using FieldOfColumn = std::array<std::optional<std::size_t>, kTrajectoryColumns.size()>;

FieldOfColumn field_of_columns(const CsvReader& table) {
  FieldOfColumn fields;
  for (std::size_t c = 0; c < kTrajectoryColumns.size(); ++c) {
    fields[c] = kTrajectoryColumns[c].required
                    ? table.column(kTrajectoryColumns[c].name, "t_s,x_m,y_m,heading_rad")
                    : table.find_column(kTrajectoryColumns[c].name);
  }
  return fields;
}

TrajectoryPoint read_row(const CsvReader& row, const FieldOfColumn& fields) {
  row.check_width();
  TrajectoryPoint point;
  for (std::size_t c = 0; c < kTrajectoryColumns.size(); ++c) {
    const double largest = kTrajectoryColumns[c].largest;
    if (fields[c]) point.*kTrajectoryColumns[c].value = row.number(*fields[c], -largest, largest);
  }
  return point;
}

void check_plausible(const std::vector<TrajectoryPoint>& points,
                     const std::vector<std::size_t>& lines, const std::string& name) {
  const auto fault = implausible_row(points);
  if (!fault) return;
  throw map::InputError({.file = name,
                         .place = std::to_string(lines[fault->row]),
                         .element = fault->column,
                         .found = fault->found,
                         .needed = fault->needed,
                         .remedy = fault->remedy});
}

}  // namespace

geometry::Trajectory parse_trajectory_csv(std::string_view bytes, const std::string& name) {
  CsvReader table(bytes, name);
  const FieldOfColumn fields = field_of_columns(table);
  std::vector<TrajectoryPoint> points;
  std::vector<std::size_t> lines;
  while (table.next_row()) {
    points.push_back(read_row(table, fields));
    lines.push_back(table.line());
    if (points.size() > 1 && !(points.back().t_s > points[points.size() - 2].t_s)) {
      table.refuse("column t_s",
                   fmt::format("{} s does not come after {} s of the row before", points.back().t_s,
                               points[points.size() - 2].t_s),
                   "increasing times", "sort the rows and remove doubles");
    }
  }
  if (points.empty()) {
    table.refuse("row", "there is none", "at least one below the header", "add it");
  }
  check_plausible(points, lines, name);
  return geometry::Trajectory(std::move(points));
}

geometry::Trajectory read_trajectory_csv(const std::filesystem::path& file) {
  return parse_trajectory_csv(map::read_file(file), file.string());
}

std::string write_trajectory_csv(const geometry::Trajectory& drive) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (std::size_t c = 0; c < kTrajectoryColumns.size(); ++c) {
    fmt::format_to(out, "{}{}", c == 0 ? "" : ",", kTrajectoryColumns[c].name);
  }
  for (const TrajectoryPoint& point : drive.points()) {
    fmt::format_to(out, "\n");
    for (std::size_t c = 0; c < kTrajectoryColumns.size(); ++c) {
      fmt::format_to(out, "{}{}", c == 0 ? "" : ",", point.*kTrajectoryColumns[c].value);
    }
  }
  fmt::format_to(out, "\n");
  return fmt::to_string(text);
}

}  // namespace roadbed::tools
