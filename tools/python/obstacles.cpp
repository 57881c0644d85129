#include <fmt/format.h>

#include <stdexcept>

#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/python/motion.h"

namespace roadbed::tools::inline python {
namespace {

using planning::ObstacleInSource;

// A pose, or poses with times.
ObstacleInSource obstacle(const std::string& id, nb::handle poses, double length_m, double width_m,
                          const std::string& kind) {
  if (!(length_m > 0.0 && width_m > 0.0)) {
    throw std::invalid_argument("length_m and width_m: need more than 0");
  }
  const Rows rows = rows_of(poses, "poses", 3, 4);
  std::vector<geometry::TrajectoryPoint> points;
  if (rows.shape(1) == 3 && rows.shape(0) != 1) {
    throw std::invalid_argument("poses: one x, y, heading, or rows of t, x, y, heading are needed");
  }
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const double* row = rows.data() + i * rows.shape(1);
    const bool is_timed = rows.shape(1) == 4;
    points.push_back(
        {.t_s = is_timed ? *row++ : 0.0, .x_m = row[0], .y_m = row[1], .heading_rad = row[2]});
  }
  ObstacleInSource made{.id = id,
                        .kind = kind,
                        .length_m = length_m,
                        .width_m = width_m,
                        .motion = geometry::Trajectory(std::move(points))};
  if (made.motion.points().size() > 1) {
    made.validity = {made.motion.start_s(), made.motion.end_s()};
  }
  return made;
}

Array2 poses_array(const ObstacleInSource& of) {
  std::vector<double> values;
  for (const geometry::TrajectoryPoint& point : of.motion.points()) {
    values.insert(values.end(), {point.t_s, point.x_m, point.y_m, point.heading_rad});
  }
  return owned<double, 2>(std::move(values), {of.motion.points().size(), 4});
}

}  // namespace

Obstacles obstacles_of(nb::handle given, std::optional<long> start_step) {
  Obstacles obstacles;
  if (given.is_none()) return obstacles;
  if (nb::isinstance<nb::str>(given) || nb::hasattr(given, "__fspath__")) {
    obstacles.file = path_of(given);
    obstacles.in_source = read_moving_obstacles(obstacles.file, Inputs(), start_step);
    return obstacles;
  }
  for (const nb::handle one : given) {
    obstacles.in_source.push_back(nb::cast<const ObstacleInSource&>(one));
  }
  return obstacles;
}

void bind_obstacles(nb::module_& module) {
  nb::class_<ObstacleInSource>(module, "Obstacle", "A rectangle that stands or moves.")
      .def(
          "__init__",
          [](ObstacleInSource* self, const std::string& id, nb::handle poses, double length_m,
             double width_m, const std::string& kind) {
            new (self) ObstacleInSource(obstacle(id, poses, length_m, width_m, kind));
          },
          nb::arg("id"), nb::arg("poses"), nb::kw_only(), nb::arg("length_m") = 4.5,
          nb::arg("width_m") = 1.8, nb::arg("kind") = "car",
          nb::sig("def __init__(self, id: str, poses: numpy.typing.ArrayLike, *, length_m: float = "
                  "4.5, width_m: float = 1.8, kind: str = 'car') -> None"),
          "poses: x, y and heading of its centre, where it stands; or rows (N, 4) of t, x, y and "
          "heading, between which it moves linearly [s, m, rad]: it is there from the first to the "
          "last.")
      .def_prop_ro("id", [](const ObstacleInSource& of) { return of.id; })
      .def_prop_ro("kind", [](const ObstacleInSource& of) { return of.kind; })
      .def_prop_ro("length_m", [](const ObstacleInSource& of) { return of.length_m; })
      .def_prop_ro("width_m", [](const ObstacleInSource& of) { return of.width_m; })
      .def_prop_ro("poses", &poses_array, nb::rv_policy::reference,
                   "Rows (N, 4) of t, x, y and heading; one: it stands.")
      .def(
          "pose_at",
          [](const ObstacleInSource& of, double t_s) {
            const geometry::Pose2 pose = of.pose_at(t_s);
            return owned(std::vector<double>{pose.x_m, pose.y_m, pose.heading_rad});
          },
          nb::arg("t_s"), "x, y and heading of its centre at a time (3).")
      .def("__repr__", [](const ObstacleInSource& of) {
        return fmt::format("<Obstacle {}: {}, {:g} m by {:g} m, {} poses>", of.id, of.kind,
                           of.length_m, of.width_m, of.motion.points().size());
      });
  module.def(
      "read_obstacles", [](nb::handle path) { return obstacles_of(path).in_source; },
      nb::arg("path"),
      nb::sig("def read_obstacles(path: str | os.PathLike[str]) -> list[Obstacle]"),
      "Those of a scenario (.json, CommonRoad .xml), or of boxes with times (.csv). Second 0 of "
      "CommonRoad's is the initial time step of its planning problem, else step 0.");
}

}  // namespace roadbed::tools::python
