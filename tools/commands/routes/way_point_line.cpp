#include "roadbed/tools/commands/routes/way_point_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/points_csv.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

using planning::ReferencePoint;

constexpr double kRateStep_m = 1e-3;  // to both sides, for the rate of a spline's curvature

int count_of_steps(double length_m, double step_m) {
  constexpr double most_rows = 3e6;  // half a gigabyte of text
  const double steps = std::ceil(length_m / step_m - 1e-6);
  if (steps <= most_rows) return static_cast<int>(steps);
  throw std::invalid_argument(
      fmt::format("{:.0f} m in steps of {} m are over {:.0f} rows", length_m, step_m, most_rows));
}

Eigen::Vector2d unit_vector(double heading_deg) {
  const double heading_rad = heading_deg * std::numbers::pi / 180.0;
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

}  // namespace

WayPointLine::Line WayPointLine::spline_line(const geometry::SplineCurve& curve) {
  const auto at = [curve](double s_m) {
    const Eigen::Vector2d tangent = curve.tangent(s_m);
    const double from_m = std::max(0.0, s_m - kRateStep_m);
    const double to_m = std::min(curve.length_m(), s_m + kRateStep_m);
    return ReferencePoint{
        .s_m = s_m,
        .in_map = curve.at(s_m),
        .heading_rad = std::atan2(tangent.y(), tangent.x()),
        .curvature_per_m = curve.curvature_per_m(s_m),
        .curvature_d1_per_m2 =
            (curve.curvature_per_m(to_m) - curve.curvature_per_m(from_m)) / (to_m - from_m)};
  };
  return {curve.length_m(), 0.0, {}, at};
}

WayPointLine::Line WayPointLine::smooth_line(const planning::ReferenceLine& line) {
  return {line.goal_s_m(), line.largest_move_m(), line.notes(),
          [line](double s_m) { return line.at(s_m); }};
}

void WayPointLine::declare(Arguments& arguments) {
  arguments.add("--waypoints", file_, "CSV file with columns x_m and y_m, instead of MAP and route")
      .reads()
      .ending(".csv");
  arguments.flag("--interpolate", interpolate_,
                 "Through the way-points: a cubic spline, not smoothed");
  arguments.choice(
      "--ends", ends_,
      {{"natural", Ends::natural}, {"clamped", Ends::clamped}, {"periodic", Ends::periodic}},
      "Ends of the spline: no curvature, the given headings, or closed");
  arguments.add("--headings", headings_deg_, "Headings of clamped ends, FIRST,LAST [deg]")
      .separated_by(',');
  arguments
      .add("--vehicle", vehicle_file_,
           std::string("Vehicle: ") + kVehicleSyntax +
               "; bends that it cannot steer are drawn wider, and what it cannot drive is noted; "
               "corners of way-points are rounded for it at the speed limit, inside the half width")
      .ending(".json .yaml");
  arguments.add("--half-width", half_width_m_, "Room to each side of a line of way-points [m]")
      .within(0.1, 100.0)
      .with_default();
  arguments.add("--speed-limit", speed_limit_kmh_, "On a line of way-points [km/h]")
      .within(1.0, 300.0)
      .with_default();
}

std::string WayPointLine::fault() const {
  const bool is_clamped = ends_ == Ends::clamped;
  if (!asked() && (interpolate_ || ends_ != Ends::natural))
    return "--interpolate and --ends need --waypoints";
  if (!vehicle_file_.empty() && interpolate_) return "--vehicle does not go with --interpolate";
  if (ends_ != Ends::natural && !interpolate_) return "--ends needs --interpolate";
  if (is_clamped != !headings_deg_.empty()) return "--ends clamped and --headings go together";
  if (is_clamped && headings_deg_.size() != 2) return "--headings needs two numbers, FIRST,LAST";
  return {};
}

std::optional<geometry::VehicleShape> WayPointLine::vehicle() const {
  if (vehicle_file_.empty()) return std::nullopt;
  return read_vehicle(vehicle_file_).shape;
}

planning::ReferenceLine WayPointLine::smoothed(const std::vector<Eigen::Vector2d>& points,
                                               double max_move_m) const {
  planning::ReferenceLineOptions options{.max_smoothing_m = max_move_m};
  options.corner_vehicle = vehicle();
  options.corner_speed_mps = speed_limit_kmh_ / 3.6;
  return planning::ReferenceLine::through(points, half_width_m_, speed_limit_kmh_ / 3.6, options);
}

geometry::SplineCurve WayPointLine::interpolated(const std::vector<Eigen::Vector2d>& points) const {
  if (ends_ == Ends::periodic) return geometry::SplineCurve::closed_through(points);
  if (ends_ == Ends::natural) return geometry::SplineCurve::through(points);
  return geometry::SplineCurve::through(points, unit_vector(headings_deg_[0]),
                                        unit_vector(headings_deg_[1]));
}

std::vector<Eigen::Vector2d> WayPointLine::way_points() const {
  PointTable table = read_point_table(file_);
  if (!table.is_lon_lat) return std::move(table.points);
  throw map::InputError({.file = map::input_name(file_),
                         .found = "holds longitudes and latitudes, and no map gives them metres",
                         .needed = "columns x_m,y_m",
                         .remedy = "project the points first"});
}

WayPointLine::Table WayPointLine::table(double step_m, double max_move_m) const {
  const std::vector<Eigen::Vector2d> points = way_points();
  try {
    return rows_of(interpolate_ ? spline_line(interpolated(points))
                                : smooth_line(smoothed(points, max_move_m)),
                   step_m);
  } catch (const std::invalid_argument& unusable) {
    throw map::InputError({.file = map::input_name(file_),
                           .element = "way-points",
                           .found = fmt::format("make no line: {}", unusable.what()),
                           .needed =
                               "two distinct points (three for a closed line), and a way that "
                               "does not turn back on itself",
                           .remedy = "mend the points, or take longer steps or a shorter way"});
  }
}

WayPointLine::Table WayPointLine::rows_of(const Line& made, double step_m) const {
  Table table{.csv = {},
              .length_m = made.length_m,
              .largest_move_m = made.largest_move_m,
              .notes = made.notes};
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text),
                 "s_m,x_m,y_m,heading_rad,curvature_per_m,curvature_rate_per_m2,left_m,right_m,"
                 "speed_limit_mps\n");
  const int steps = count_of_steps(made.length_m, step_m);
  double heading_rad = made.at(0.0).heading_rad;
  for (int i = 0; i <= steps; ++i) {
    const double s_m = std::min(made.length_m, i * step_m);
    const ReferencePoint at = made.at(s_m);
    heading_rad += geometry::wrap_angle(at.heading_rad - heading_rad);
    table.peak_curvature_per_m = std::max(table.peak_curvature_per_m, std::abs(at.curvature_per_m));
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", s_m, at.in_map.x(),
                   at.in_map.y(), heading_rad, at.curvature_per_m, at.curvature_d1_per_m2,
                   half_width_m_, half_width_m_, speed_limit_kmh_ / 3.6);
  }
  table.csv = fmt::to_string(text);
  return table;
}

}  // namespace roadbed::tools::commands::routes
