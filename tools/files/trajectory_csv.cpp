#include "roadbed/tools/files/trajectory_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/csv.h"

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

using Eigen::Vector2d;

double step_m(const TrajectoryPoint& from, const TrajectoryPoint& to) {
  const double dx_m = to.x_m - from.x_m, dy_m = to.y_m - from.y_m;
  return std::sqrt(dx_m * dx_m + dy_m * dy_m);
}

// The shorter way round.
double turn_rad(const TrajectoryPoint& from, const TrajectoryPoint& to) {
  const double turned_rad = std::abs(to.heading_rad - from.heading_rad);
  if (turned_rad <= std::numbers::pi) return turned_rad;
  return std::abs(std::remainder(turned_rad, 2.0 * std::numbers::pi));
}

/// How far headings are off the path driven, in the mean over pieces of a metre, forwards or
/// backwards.
class HeadingError {
 public:
  explicit HeadingError(double rad_per_unit) : rad_per_unit_(rad_per_unit) {}

  void add(const TrajectoryPoint& from, const TrajectoryPoint& to) {
    const Vector2d axis = axis_of(from) + axis_of(to);
    const double way_rad = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
    sum_rad_ +=
        std::abs(std::remainder(std::atan2(axis.y(), axis.x()) - way_rad, std::numbers::pi));
    count_ += 1.0;
  }
  double mean_rad() const { return count_ > 0.0 ? sum_rad_ / count_ : 0.0; }

 private:
  Vector2d axis_of(const TrajectoryPoint& row) const {
    const double heading_rad = rad_per_unit_ * row.heading_rad;
    return {std::cos(heading_rad), std::sin(heading_rad)};
  }

  double rad_per_unit_, sum_rad_ = 0.0, count_ = 0.0;
};

// The first row at least a metre from another, none if there is none.
std::optional<std::size_t> metre_after(const std::vector<TrajectoryPoint>& rows, std::size_t from) {
  constexpr double piece_m = 1.0;
  for (std::size_t i = from + 1; i < rows.size(); ++i) {
    if (step_m(rows[from], rows[i]) >= piece_m) return i;
  }
  return std::nullopt;
}

std::optional<ImplausibleRow> headings_in_degrees(const std::vector<TrajectoryPoint>& rows) {
  // Headings of over a turn are seldom radians: less of an error speaks against them.
  constexpr double fits_rad = 0.1, off_rad = 0.12, off_beyond_a_turn_rad = 0.04, times_worse = 3.0;
  HeadingError as_radians(1.0), as_degrees(geometry::kRadiansPerDegree);
  std::size_t largest = 0, from = 0;
  for (auto to = metre_after(rows, from); to; to = metre_after(rows, from)) {
    as_radians.add(rows[from], rows[*to]);
    as_degrees.add(rows[from], rows[*to]);
    from = *to;
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (std::abs(rows[i].heading_rad) > std::abs(rows[largest].heading_rad)) largest = i;
  }
  const double fit_rad = as_degrees.mean_rad(), error_rad = as_radians.mean_rad();
  const bool is_over_a_turn = std::abs(rows[largest].heading_rad) > 2.0 * std::numbers::pi;
  const double least_rad = is_over_a_turn ? off_beyond_a_turn_rad : off_rad;
  if (fit_rad > fits_rad || error_rad < least_rad || error_rad < times_worse * fit_rad) {
    return std::nullopt;
  }
  return ImplausibleRow{
      largest, "column heading_rad",
      fmt::format("{:g} looks like degrees: as such the headings fit the way driven, as radians "
                  "they are {:.2f} rad off",
                  rows[largest].heading_rad, error_rad),
      "radians", "divide the headings by 57.29577951308232"};
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
  if (!table.find_column("speed_mps")) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].speed_mps = speed_of_way_mps(points, i);
    }
  }
  return geometry::Trajectory(std::move(points));
}

geometry::Trajectory read_trajectory_csv(const std::filesystem::path& file) {
  return parse_trajectory_csv(map::read_file(file, map::most_unpacked_of_rows),
                              map::input_name(file));
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

double speed_of_way_mps(const std::vector<TrajectoryPoint>& rows, std::size_t i) {
  const TrajectoryPoint& from = rows[i == 0 ? 0 : i - 1];
  const TrajectoryPoint& to = rows[std::min(i + 1, rows.size() - 1)];
  if (!(to.t_s > from.t_s)) return 0.0;
  return ((to.x_m - from.x_m) * std::cos(rows[i].heading_rad) +
          (to.y_m - from.y_m) * std::sin(rows[i].heading_rad)) /
         (to.t_s - from.t_s);
}

std::optional<ImplausibleRow> too_far_apart(const std::vector<TrajectoryPoint>& rows) {
  constexpr double looked_at_m = 0.2;  // by who follows a drive most closely, planning/rules
  const double most_m = looked_at_m * static_cast<double>(geometry::most_steps(rows.size()));
  double way_m = 0.0, longest_m = 0.0;
  std::size_t longest = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double row_m = step_m(rows[i - 1], rows[i]);
    way_m += row_m;
    if (row_m <= longest_m) continue;
    longest_m = row_m;
    longest = i;
  }
  if (way_m <= most_m) return std::nullopt;
  return ImplausibleRow{
      longest, "columns x_m, y_m",
      fmt::format("{:.6g} m from the row before, in a drive of {:.6g} m", longest_m, way_m),
      fmt::format("at most {:.6g} m in {} rows", most_m, rows.size()),
      "remove the outlier, or give more rows between"};
}

// Degrees turn by impossible steps as well, and are the better word for it.
std::optional<ImplausibleRow> implausible_row(const std::vector<TrajectoryPoint>& rows) {
  if (auto degrees = headings_in_degrees(rows)) return degrees;
  if (auto step = impossible_step(rows)) return step;
  return too_far_apart(rows);
}

std::optional<ImplausibleRow> impossible_step(const std::vector<TrajectoryPoint>& rows) {
  constexpr double fastest_mps = 150.0, noise_m = 1.0, fastest_radps = 5.0, noise_rad = 0.5;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double took_s = rows[i].t_s - rows[i - 1].t_s, way_m = step_m(rows[i - 1], rows[i]);
    const double turned_rad = turn_rad(rows[i - 1], rows[i]);
    if (way_m > fastest_mps * took_s + noise_m) {
      return ImplausibleRow{i, "columns x_m, y_m",
                            fmt::format("{:.6g} m in {:.3g} s from the row before", way_m, took_s),
                            fmt::format("steps that a vehicle makes, under {} m/s", fastest_mps),
                            "remove the outlier, or cut the drive there"};
    }
    if (turned_rad > fastest_radps * took_s + noise_rad) {
      return ImplausibleRow{
          i, "column heading_rad",
          fmt::format("turns by {:.3g} rad in {:.3g} s from the row before", turned_rad, took_s),
          fmt::format("the heading of the body in radians, which turns by less than {} rad/s",
                      fastest_radps),
          "give radians, and the body's heading where it backs up too"};
    }
  }
  return std::nullopt;
}

std::string curvature_note(const geometry::Trajectory& drive, const geometry::VehicleShape& shape) {
  constexpr double beyond = 1.02, least_turn_rad = 0.05;
  const double most_per_m = std::tan(shape.max_steering_rad) / shape.wheelbase_m;
  const auto& rows = drive.points();
  double worst_per_m = 0.0, at_s = 0.0;
  std::size_t from = 0;
  double way_m = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    way_m += step_m(rows[i - 1], rows[i]);
    const double turned_rad = std::abs(rows[i].heading_rad - rows[from].heading_rad);
    const bool is_on_the_spot = turned_rad > most_per_m * beyond && way_m < 1.0;
    if (way_m < 1.0 && !is_on_the_spot) continue;
    const double per_m = turned_rad / std::max(way_m, 1e-3);
    if (turned_rad > least_turn_rad && per_m > worst_per_m) {
      worst_per_m = per_m;
      at_s = rows[from].t_s;
    }
    from = i;
    way_m = 0.0;
  }
  if (worst_per_m <= beyond * most_per_m) return {};
  return fmt::format(
      "at {:.3f} s the drive bends by {:.3g} 1/m, and the vehicle by {:.3g} 1/m at "
      "most",
      at_s, worst_per_m, most_per_m);
}

}  // namespace roadbed::tools::files
