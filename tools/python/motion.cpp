#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/python/motion.h"

namespace roadbed::tools::inline python {
namespace {

constexpr std::size_t kColumns = 8;
static_assert(sizeof(geometry::TrajectoryPoint) == kColumns * sizeof(double));

// The drive's own memory: its rows are eight numbers one behind the other.
Array2 array_of(nb::handle self) {
  const auto& points = nb::cast<const Trajectory&>(self).drive.points();
  const std::size_t shape[] = {points.size(), kColumns};
  return {reinterpret_cast<const double*>(points.data()), 2, shape, self};
}

template <std::size_t kColumn>
Array1 column_of(nb::handle self) {
  const auto& points = nb::cast<const Trajectory&>(self).drive.points();
  const std::size_t shape[] = {points.size()};
  const std::int64_t stride[] = {kColumns};
  return {reinterpret_cast<const double*>(points.data()) + kColumn, 1, shape, self, stride};
}

// The checks of a file's rows, of an array's.
Trajectory trajectory_from(nb::handle rows) {
  const Rows numbers = rows_of(rows, "trajectory", 4, kColumns);
  const std::size_t columns = numbers.shape(1);
  std::vector<geometry::TrajectoryPoint> points(numbers.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto* into = reinterpret_cast<double*>(&points[i]);
    std::copy_n(numbers.data() + i * columns, columns, into);
  }
  if (const auto fault = implausible_row(points)) {
    throw map::InputError({.file = "trajectory",
                           .place = fmt::format("row {}", fault->row),
                           .element = fault->column,
                           .found = fault->found,
                           .needed = fault->needed,
                           .remedy = fault->remedy});
  }
  return {geometry::Trajectory(std::move(points)), {}};
}

/// The options of a file of a drive. @throws std::invalid_argument if one is none.
DriveOptions drive_options(const std::string& topic, const std::string& frame, nb::handle vehicle,
                           std::optional<double> rate_hz) {
  if (rate_hz && !(*rate_hz >= 1e-3 && *rate_hz <= 1e6)) {
    throw std::invalid_argument(fmt::format("rate_hz: {}, needs 0.001 to 1e6", *rate_hz));
  }
  DriveOptions options{.topic = topic, .pose_frame = {}, .rate_hz = rate_hz};
  if (frame.empty()) return options;
  options.pose_frame = pose_frame(frame, shape_of(vehicle));
  if (!options.pose_frame) {
    throw std::invalid_argument(
        fmt::format("pose_frame: \"{}\", needs {}", frame, kPoseFrameSyntax));
  }
  return options;
}

/// Certificates are about tables only, which need no options.
Trajectory drive_of_file(const std::filesystem::path& file, const DriveOptions& options) {
  const nb::gil_scoped_release released;
  DriveOfFile read = read_drive(file, options);
  return {std::move(read.drive), is_drive_table(file) ? file : std::filesystem::path(),
          is_solution(file) ? vehicle_of_solution(file) : std::string(), std::move(read.gaps)};
}

void bind_trajectory(nb::module_& module) {
  nb::class_<Trajectory>(module, "Trajectory",
                         "A drive: states of the rear axle's centre at increasing times, in the "
                         "coordinates of the files; between them everything is linear.")
      .def(
          "__init__",
          [](Trajectory* self, nb::handle rows) { new (self) Trajectory(trajectory_from(rows)); },
          nb::arg("rows"), nb::sig("def __init__(self, rows: numpy.typing.ArrayLike) -> None"),
          "From an (N, 4) to (N, 8) array with the columns t [s], x, y [m], heading [rad], speed "
          "[m/s], acceleration [m/s²], steering [rad], curvature [1/m]; those left out are 0.\n\n"
          "Raises InputError if no vehicle can drive so.")
      .def_static(
          "open",
          [](nb::handle path, const std::string& topic, const std::string& pose_frame,
             nb::handle vehicle, std::optional<double> rate_hz) {
            return drive_of_file(path_of(path), drive_options(topic, pose_frame, vehicle, rate_hz));
          },
          nb::arg("path"), nb::kw_only(), nb::arg("topic") = "", nb::arg("pose_frame") = "",
          nb::arg("vehicle") = nb::none(), nb::arg("rate_hz") = nb::none(),
          nb::sig("def open(path: str | os.PathLike[str], *, topic: str = '', pose_frame: str = "
                  "'', vehicle: Vehicle | str | os.PathLike[str] | None = None, rate_hz: float | "
                  "None = None) -> Trajectory"),
          "Reads a drive, told by content: a CSV file with the columns t_s, x_m, y_m, heading_rad "
          "and the like; a log (rosbag2, MCAP); a CommonRoad solution; poses of Argoverse 2, TUM "
          "or KITTI.\n\n"
          "topic: of a log, where several could be the drive; pose_frame: which point the poses "
          "are, \"rear-axle\", \"centre\" of the vehicle's body, or \"X,Y[,HEADING]\" ahead and to "
          "the left of the rear axle, \"camera[:X,Y[,HEADING]]\" for a camera's (x right, y down, "
          "z "
          "ahead); rate_hz: poses in a second, where the file has no times.")
      .def(
          "save",
          [](Trajectory& self, nb::handle path) {
            const std::filesystem::path file = path_of(path);
            map::write_output(file, write_trajectory_csv(self.drive), true);
            self.file = file;
          },
          nb::arg("path"), nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
          "Writes that file, over what is there.")
      .def_prop_ro("array", &array_of, "All of it (N, 8), without a copy.")
      .def_prop_ro("t_s", &column_of<0>, "Times [s].")
      .def_prop_ro("x_m", &column_of<1>, "x of the rear axle's centre [m].")
      .def_prop_ro("y_m", &column_of<2>, "y of the rear axle's centre [m].")
      .def_prop_ro("heading_rad", &column_of<3>, "Headings, unwrapped [rad].")
      .def_prop_ro("speed_mps", &column_of<4>, "Speeds [m/s].")
      .def_prop_ro("acceleration_mps2", &column_of<5>, "Along the vehicle [m/s²].")
      .def_prop_ro("steering_rad", &column_of<6>,
                   "Of the front wheels, positive to the left [rad].")
      .def_prop_ro("curvature_per_m", &column_of<7>, "Of the path, positive to the left [1/m].")
      .def("__len__", [](const Trajectory& self) { return self.drive.points().size(); })
      .def("__repr__", [](const Trajectory& self) {
        if (self.drive.empty()) return std::string("<Trajectory: empty>");
        return fmt::format("<Trajectory: {} rows, {:g} to {:g} s>", self.drive.points().size(),
                           self.drive.start_s(), self.drive.end_s());
      });
}

void bind_parts(nb::class_<VehicleOfFile>& bound) {
  bound
      .def(
          "add_part",
          [](VehicleOfFile& self, const std::string& name, double rear_m, double front_m,
             double right_m, double left_m, double from_height_m, double to_height_m) {
            geometry::BodyPart part{name,   rear_m, front_m,       right_m,
                                    left_m, 0.0,    from_height_m, to_height_m};
            part.check();
            self.vehicle.more.push_back(part);
            self.file.clear();
          },
          nb::arg("name"), nb::kw_only(), nb::arg("rear_m"), nb::arg("front_m"), nb::arg("right_m"),
          nb::arg("left_m"), nb::arg("from_height_m"), nb::arg("to_height_m"),
          "A box beside the body, for audits: mirrors, a load; x forward and y left of the rear "
          "axle, heights above the ground [m].")
      .def_prop_ro(
          "parts",
          [](const VehicleOfFile& self) {
            std::vector<std::string> names;
            for (const geometry::BodyPart& part : self.vehicle.parts(0.2)) {
              names.push_back(part.name);
            }
            return names;
          },
          "Names of all parts, the body first.");
}

template <double geometry::VehicleShape::*kMember>
void bind_measure(nb::class_<VehicleOfFile>& bound, const char* name) {
  bound.def_prop_ro(name, [](const VehicleOfFile& self) { return self.vehicle.shape.*kMember; });
}

}  // namespace

Trajectory trajectory_of(nb::handle given) {
  if (nb::isinstance<Trajectory>(given)) return nb::cast<const Trajectory&>(given);
  if (nb::isinstance<nb::str>(given) || nb::hasattr(given, "__fspath__")) {
    return drive_of_file(path_of(given), {});
  }
  return trajectory_from(given);
}

VehicleOfFile vehicle_of(nb::handle given) {
  if (given.is_none()) return {};
  if (nb::isinstance<VehicleOfFile>(given)) return nb::cast<const VehicleOfFile&>(given);
  const std::filesystem::path file = path_of(given);
  return {read_vehicle(file), file};
}

geometry::VehicleShape shape_of(nb::handle given) {
  const VehicleOfFile vehicle = vehicle_of(given);
  if (vehicle.vehicle.circles.empty() && vehicle.vehicle.more.empty()) return vehicle.vehicle.shape;
  throw std::invalid_argument("vehicle: has parts, which only audits look at");
}

void bind_motion(nb::module_& module) {
  bind_trajectory(module);
  nb::class_<VehicleOfFile> bound(module, "Vehicle",
                                  "A car-like vehicle. The defaults are CommonRoad's vehicle 2, a "
                                  "BMW 320i. Wherever one is asked for, the path of its file will "
                                  "do.");
  bound
      .def(
          "__init__",
          [](VehicleOfFile* self, double length_m, double width_m, double rear_overhang_m,
             double wheelbase_m, double height_m, double max_steering_rad,
             double max_steering_rate_radps) {
            const geometry::VehicleShape shape{
                length_m, width_m,          rear_overhang_m,        wheelbase_m,
                height_m, max_steering_rad, max_steering_rate_radps};
            shape.check();
            new (self) VehicleOfFile{{shape, {}, {}}, {}};
          },
          nb::kw_only(), nb::arg("length_m") = 4.508, nb::arg("width_m") = 1.610,
          nb::arg("rear_overhang_m") = 0.8312829, nb::arg("wheelbase_m") = 2.5789128,
          nb::arg("height_m") = 1.5, nb::arg("max_steering_rad") = 1.066,
          nb::arg("max_steering_rate_radps") = 0.4)
      .def_static(
          "open",
          [](nb::handle path) {
            const std::filesystem::path file = path_of(path);
            return VehicleOfFile{read_vehicle(file), file};
          },
          nb::arg("path"), nb::sig("def open(path: str | os.PathLike[str]) -> Vehicle"),
          "Reads a vehicle's file.")
      .def("__repr__", [](const VehicleOfFile& self) {
        return fmt::format("<Vehicle: {:g} m by {:g} m, {:g} m high>", self.vehicle.shape.length_m,
                           self.vehicle.shape.width_m, self.vehicle.shape.height_m);
      });
  bind_measure<&geometry::VehicleShape::length_m>(bound, "length_m");
  bind_measure<&geometry::VehicleShape::width_m>(bound, "width_m");
  bind_measure<&geometry::VehicleShape::rear_overhang_m>(bound, "rear_overhang_m");
  bind_measure<&geometry::VehicleShape::wheelbase_m>(bound, "wheelbase_m");
  bind_measure<&geometry::VehicleShape::height_m>(bound, "height_m");
  bind_measure<&geometry::VehicleShape::max_steering_rad>(bound, "max_steering_rad");
  bind_measure<&geometry::VehicleShape::max_steering_rate_radps>(bound, "max_steering_rate_radps");
  bind_parts(bound);
}

}  // namespace roadbed::tools::python
