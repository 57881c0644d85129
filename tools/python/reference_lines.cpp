#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "roadbed/tools/python/routes.h"

namespace roadbed::tools::inline python {
namespace {

using planning::Corridor;
using planning::ReferencePoint;

/// Rows of a line, a column each; named as in the files of `roadbed reference`.
nb::dict table_of(const LineOfMap& of, const std::vector<double>& stations) {
  std::vector<ReferencePoint> points;
  std::vector<Corridor> rooms;
  {
    const nb::gil_scoped_release released;
    for (const double s_m : stations) {
      points.push_back(of.line.at(s_m));
      rooms.push_back(of.line.corridor_at(s_m));
    }
  }
  nb::dict table;
  const auto add = [&](const char* name, const auto& rows, auto get) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const auto& row : rows) values.push_back(get(row));
    table[name] = owned(std::move(values));
  };
  const Eigen::Vector2d& origin = of.origin_in_source;
  add("s_m", stations, [](double s_m) { return s_m; });
  add("x_m", points, [&](const ReferencePoint& point) { return point.in_map.x() + origin.x(); });
  add("y_m", points, [&](const ReferencePoint& point) { return point.in_map.y() + origin.y(); });
  add("heading_rad", points, [](const ReferencePoint& point) { return point.heading_rad; });
  add("curvature_per_m", points, [](const ReferencePoint& point) { return point.curvature_per_m; });
  add("curvature_rate_per_m2", points,
      [](const ReferencePoint& point) { return point.curvature_d1_per_m2; });
  add("left_m", rooms, [](const Corridor& room) { return room.left_m; });
  add("right_m", rooms, [](const Corridor& room) { return room.right_m; });
  add("speed_limit_mps", rooms, [](const Corridor& room) { return room.speed_limit_mps; });
  return table;
}

/// From the start to the goal, the last step shortened.
std::vector<double> stations_of(const planning::ReferenceLine& line, double step_m) {
  if (!(step_m >= 1e-3)) throw std::invalid_argument("step_m: needs 0.001 or more");
  std::vector<double> stations;
  const double end_m = line.goal_s_m();
  for (int i = 0; i * step_m < end_m - 1e-6; ++i) stations.push_back(i * step_m);
  stations.push_back(end_m);
  return stations;
}

Array2 line_to_xy(const LineOfMap& of, nb::handle places) {
  const Rows rows = rows_of(places, "places", 2);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const ReferencePoint on_line = of.line.at(rows.data()[2 * i]);
    const Eigen::Vector2d normal(-std::sin(on_line.heading_rad), std::cos(on_line.heading_rad));
    points.push_back(on_line.in_map + rows.data()[2 * i + 1] * normal);
  }
  return points_array(points, of.origin_in_source);
}

Array2 project(const LineOfMap& of, nb::handle points) {
  const Rows rows = rows_of(points, "points", 2);
  std::vector<double> places;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const Eigen::Vector2d in_source(rows.data()[2 * i], rows.data()[2 * i + 1]);
    const geometry::LinePosition place = of.line.project(in_source - of.origin_in_source);
    places.insert(places.end(), {place.s_m, place.d_m});
  }
  return owned<double, 2>(std::move(places), {rows.shape(0), 2});
}

LineOfMap through(nb::handle points, double half_width_m, double speed_limit_mps,
                  double max_move_m) {
  const Rows rows = rows_of(points, "points", 2);
  if (rows.shape(0) < 2) throw std::invalid_argument("points: needs two or more");
  const Eigen::Vector2d origin(std::floor(rows.data()[0]), std::floor(rows.data()[1]));
  std::vector<Eigen::Vector2d> in_map;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    in_map.push_back(Eigen::Vector2d(rows.data()[2 * i], rows.data()[2 * i + 1]) - origin);
  }
  const nb::gil_scoped_release released;
  return {nullptr,
          planning::ReferenceLine::through(in_map, half_width_m, speed_limit_mps,
                                           {.max_smoothing_m = max_move_m}),
          origin};
}

}  // namespace

void bind_reference_lines(nb::module_& module) {
  nb::class_<LineOfMap>(module, "ReferenceLine",
                        "A smooth line to drive along: its heading, curvature and the derivatives "
                        "of the curvature up to the fourth are continuous, `s` is arc length.")
      .def_static("through", &through, nb::arg("points"), nb::kw_only(),
                  nb::arg("half_width_m") = 1.75, nb::arg("speed_limit_mps") = 50.0 / 3.6,
                  nb::arg("max_move_m") = planning::ReferenceLineOptions{}.max_smoothing_m,
                  nb::sig("def through(points: numpy.typing.ArrayLike, *, half_width_m: float = "
                          "1.75, speed_limit_mps: float = 13.88888888888889, max_move_m: float = "
                          "0.3) -> ReferenceLine"),
                  "A line through way-points (N, 2) [m], no map needed.\n\n"
                  "half_width_m: room on both sides; max_move_m: largest distance from a way-point "
                  "[m].")
      .def_prop_ro(
          "goal_s_m", [](const LineOfMap& of) { return of.line.goal_s_m(); },
          "Station of the route's goal, or of the last way-point [m].")
      .def_prop_ro(
          "length_m", [](const LineOfMap& of) { return of.line.length_m(); },
          "The line goes on a little past the goal [m].")
      .def_prop_ro(
          "largest_move_m", [](const LineOfMap& of) { return of.line.largest_move_m(); },
          "Largest distance from the centrelines, or of a way-point [m].")
      .def_prop_ro(
          "notes", [](const LineOfMap& of) { return of.line.notes(); },
          "What cannot be driven as asked, a line each.")
      .def(
          "sample",
          [](const LineOfMap& of, double step_m) {
            return table_of(of, stations_of(of.line, step_m));
          },
          nb::arg("step_m") = 0.5,
          nb::sig("def sample(self, step_m: float = 0.5) -> "
                  "dict[str, numpy.typing.NDArray[numpy.float64]]"),
          "The line from start to goal as columns: s_m, x_m, y_m, heading_rad, curvature_per_m, "
          "curvature_rate_per_m2, left_m and right_m (room to the road's edges), speed_limit_mps.")
      .def(
          "at",
          [](const LineOfMap& of, nb::handle stations) {
            const Rows rows = rows_of(
                nb::module_::import_("numpy").attr("reshape")(stations, nb::make_tuple(-1, 1)),
                "s_m", 1);
            return table_of(of, {rows.data(), rows.data() + rows.shape(0)});
          },
          nb::arg("s_m"),
          nb::sig("def at(self, s_m: numpy.typing.ArrayLike) -> "
                  "dict[str, numpy.typing.NDArray[numpy.float64]]"),
          "The same columns at stations of one's own (N) [m].")
      .def("to_xy", &line_to_xy, nb::arg("places"),
           nb::sig("def to_xy(self, places: numpy.typing.ArrayLike) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Points (N, 2) of places (N, 2): s along the line, d to its left [m].")
      .def("project", &project, nb::arg("points"),
           nb::sig("def project(self, points: numpy.typing.ArrayLike) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Places (N, 2), s and d, of the feet of perpendiculars from points (N, 2) [m].")
      .def("__repr__", [](const LineOfMap& of) {
        return fmt::format("<ReferenceLine: {:.1f} m>", of.line.goal_s_m());
      });
}

}  // namespace roadbed::tools::python
