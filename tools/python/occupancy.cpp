#include "roadbed/tools/python/occupancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/map/storage/output_file.h"

namespace roadbed::tools::inline python {

std::shared_ptr<const map::ClearanceField> Occupancy::field(const map::HeightBand& band) const {
  const std::lock_guard lock(mutex_);
  auto& kept = fields_[{band.from_m, band.to_m}];
  if (!kept) kept = std::make_shared<const map::ClearanceField>(*source, band);
  return kept;
}

const map::OccupancyMap& Occupancy::octree() const {
  if (const auto* made = dynamic_cast<const map::OccupancyMap*>(source.get())) return *made;
  throw std::invalid_argument("a folder of tiles is no single octree");
}

namespace {

constexpr double kNothingNear = std::numeric_limits<double>::infinity();
constexpr std::size_t kPosesAtOnce = 4096;

Eigen::Vector3d point_at(const Rows& rows, std::size_t i) {
  const double* row = rows.data() + 3 * i;
  return {row[0], row[1], row[2]};
}

/// Points as a file would hold them: measured from one place, each from its own, or from nowhere.
map::PointCloud cloud_of(nb::handle points, nb::handle sensors, const std::string& name) {
  const Rows rows = rows_of(points, name, 3);
  map::RawCloud raw;
  raw.format = "array";
  if (sensors.is_none()) {
    for (std::size_t i = 0; i < rows.shape(0); ++i) raw.add(point_at(rows, i));
  } else {
    const Rows from = rows_of(sensors, "sensors", 3);
    if (from.shape(0) != 1 && from.shape(0) != rows.shape(0)) {
      throw std::invalid_argument(
          fmt::format("sensors: {}, needs one position, or one for each of {} points",
                      from.shape(0), rows.shape(0)));
    }
    const bool is_one = from.shape(0) == 1;
    if (is_one) raw.sensor_in_source = point_at(from, 0);
    for (std::size_t i = 0; i < rows.shape(0); ++i) {
      is_one ? raw.add(point_at(rows, i)) : raw.add(point_at(rows, i), point_at(from, i));
    }
  }
  if (raw.empty()) throw std::invalid_argument(name + ": not one finite point");
  map::PointCloud cloud = map::relative_to_origin(std::move(raw));
  cloud.name = name;
  return cloud;
}

struct BuildChoice {
  map::OccupancyOptions options;
  std::string crs;
};

std::unique_ptr<Occupancy> from_points(nb::handle points, nb::handle sensors,
                                       const BuildChoice& choice) {
  std::vector<map::PointCloud> clouds;
  if (nb::isinstance<nb::list>(points) && nb::len(points) > 0 &&
      nb::hasattr(points[nb::int_(0)], "ndim") &&
      nb::cast<int>(points[nb::int_(0)].attr("ndim")) == 2) {
    for (std::size_t i = 0; i < nb::len(points); ++i) {
      const nb::object sensor = sensors.is_none() ? nb::none() : nb::object(sensors[nb::int_(i)]);
      clouds.push_back(cloud_of(points[nb::int_(i)], sensor, fmt::format("points[{}]", i)));
    }
  } else {
    clouds.push_back(cloud_of(points, sensors, "points"));
  }
  for (map::PointCloud& cloud : clouds) cloud.crs = choice.crs;
  const nb::gil_scoped_release released;
  return std::make_unique<Occupancy>(
      std::make_shared<const map::OccupancyMap>(map::OccupancyMap::build(clouds, choice.options)));
}

map::OccupancyOptions build_options(double resolution_m, double carve_range_m, bool sticky_hits,
                                    int remove_seen_through) {
  if (!(resolution_m >= 1e-3 && resolution_m <= 1e3)) {
    throw std::invalid_argument(fmt::format("resolution_m: {}, needs 0.001 to 1000", resolution_m));
  }
  return {resolution_m, carve_range_m, sticky_hits, remove_seen_through};
}

struct ClearanceQuestion {
  geometry::VehicleShape shape;
  map::HeightBand band;
  double within_m;
  map::ObstacleKind kind;
  int threads;
};

Array1 clearance(const Occupancy& occupancy, nb::handle poses, const ClearanceQuestion& question) {
  const Rows rows = rows_of(poses, "poses", 3);
  std::vector<double> distances(rows.shape(0), kNothingNear);
  {
    const nb::gil_scoped_release released;
    const auto field = occupancy.field(question.band);
    map::in_threads((distances.size() + kPosesAtOnce - 1) / kPosesAtOnce, question.threads,
                    [&](std::size_t batch) {
                      const std::size_t to = std::min(distances.size(), (batch + 1) * kPosesAtOnce);
                      for (std::size_t i = batch * kPosesAtOnce; i < to; ++i) {
                        const double* row = rows.data() + 3 * i;
                        const auto near =
                            field->nearest(geometry::Pose2{row[0], row[1], row[2]}, question.shape,
                                           question.within_m, question.kind);
                        if (near) distances[i] = near->distance_m;
                      }
                    });
  }
  return owned(std::move(distances));
}

nb::dict cells_of(const Occupancy& occupancy) {
  std::vector<double> centres, sizes;
  std::vector<std::int8_t> occupied;
  {
    const nb::gil_scoped_release released;
    occupancy.source->for_each_cell([&](const map::OccupancyCell& cell) {
      centres.insert(centres.end(), cell.centre_in_source.begin(), cell.centre_in_source.end());
      sizes.push_back(cell.size_m);
      occupied.push_back(cell.state == map::CellState::occupied ? 1 : 0);
    });
  }
  nb::dict columns;
  columns["centre"] = owned<double, 2>(std::move(centres), {sizes.size(), 3});
  columns["size_m"] = owned(std::move(sizes));
  columns["occupied"] = nb::cast(owned(std::move(occupied))).attr("astype")("bool");
  return columns;
}

nb::ndarray<nb::numpy, const std::int8_t, nb::ndim<1>> states_at(const Occupancy& occupancy,
                                                                 nb::handle points) {
  const Rows rows = rows_of(points, "points", 3);
  std::vector<std::int8_t> states;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const map::CellState state = occupancy.octree().at(point_at(rows, i));
    states.push_back(state == map::CellState::unknown ? -1 : state == map::CellState::free ? 0 : 1);
  }
  return owned(std::move(states));
}

void save(Occupancy& occupancy, nb::handle path) {
  const std::filesystem::path file = path_of(path);
  const std::string suffix = file.extension().string();
  if (suffix != ".bt" && suffix != ".ot") {
    throw std::invalid_argument(file.string() + " ends neither in .bt nor in .ot");
  }
  {
    const nb::gil_scoped_release released;
    const map::OccupancyMap& octree = occupancy.octree();
    map::write_output(file, suffix == ".ot" ? octree.to_ot() : octree.to_bt(), true);
  }
  occupancy.file = file;
}

nb::object bounds_in_source(const Occupancy& occupancy) {
  const std::optional<map::Box3> box = occupancy.source->bounds();
  if (!box) return nb::none();
  std::vector<double> values(box->min_in_source.begin(), box->min_in_source.end());
  values.insert(values.end(), box->max_in_source.begin(), box->max_in_source.end());
  return nb::cast(owned<double, 2>(std::move(values), {2, 3}));
}

void bind_building(nb::class_<Occupancy>& bound) {
  bound
      .def_static(
          "from_points",
          [](nb::handle points, nb::handle sensors, double resolution_m, double carve_range_m,
             bool sticky_hits, int remove_seen_through, std::string crs) {
            return from_points(
                points, sensors,
                {build_options(resolution_m, carve_range_m, sticky_hits, remove_seen_through),
                 std::move(crs)});
          },
          nb::arg("points"), nb::arg("sensors") = nb::none(), nb::kw_only(),
          nb::arg("resolution_m") = 0.1,
          nb::arg("carve_range_m") = std::numeric_limits<double>::infinity(),
          nb::arg("sticky_hits") = true, nb::arg("remove_seen_through") = 0, nb::arg("crs") = "",
          nb::sig("def from_points(points: numpy.typing.ArrayLike | list[numpy.typing.ArrayLike], "
                  "sensors: numpy.typing.ArrayLike | list[numpy.typing.ArrayLike] | None = None, "
                  "*, resolution_m: float = 0.1, carve_range_m: float = float('inf'), sticky_hits: "
                  "bool = True, remove_seen_through: int = 0, crs: str = '') -> Occupancy"),
          "From measured points (N, 3) in metres, or a list of such arrays, one a scan.\n\n"
          "sensors: where they were measured from, one place (3) or one for each point (N, 3); of "
          "a list of scans, a list. Rays from there make space free; without it only hits are "
          "marked, and all else stays unknown. A measured hit stays occupied whatever rays pass "
          "through its cell, unless sticky_hits is off, or remove_seen_through scans see through "
          "it.")
      .def_static(
          "from_files",
          [](nb::handle paths, double resolution_m, double carve_range_m, bool sticky_hits,
             int remove_seen_through) {
            std::vector<std::filesystem::path> files;
            for (const nb::handle path : paths) files.push_back(path_of(path));
            const map::OccupancyOptions options =
                build_options(resolution_m, carve_range_m, sticky_hits, remove_seen_through);
            const nb::gil_scoped_release released;
            return std::make_unique<Occupancy>(
                std::make_shared<const map::OccupancyMap>(map::load_occupancy(files, options)));
          },
          nb::arg("paths"), nb::kw_only(), nb::arg("resolution_m") = 0.1,
          nb::arg("carve_range_m") = std::numeric_limits<double>::infinity(),
          nb::arg("sticky_hits") = true, nb::arg("remove_seen_through") = 0,
          nb::sig("def from_files(paths: collections.abc.Iterable[str | os.PathLike[str]], *, "
                  "resolution_m: float = 0.1, carve_range_m: float = float('inf'), sticky_hits: "
                  "bool = True, remove_seen_through: int = 0) -> Occupancy"),
          "From point clouds (.pcd .ply .las .laz .xyz .csv), with the sensor positions that they "
          "name.")
      .def_static(
          "open",
          [](nb::handle path) {
            const std::filesystem::path file = path_of(path);
            const nb::gil_scoped_release released;
            return std::make_unique<Occupancy>(
                std::shared_ptr<const map::OccupancySource>(map::open_occupancy(file)), file);
          },
          nb::arg("path"), nb::sig("def open(path: str | os.PathLike[str]) -> Occupancy"),
          "Reads an OctoMap file (.bt .ot), or a folder of tiles, of which only those are read "
          "that "
          "are asked for.")
      .def("save", &save, nb::arg("path"),
           nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
           "Writes an OctoMap file: .bt, or .ot with log-odds, over what is there.");
}

}  // namespace

void bind_occupancy(nb::module_& module) {
  nb::class_<Occupancy> bound(module, "Occupancy",
                              "Space that was measured: cells that are occupied or free; all else "
                              "is unknown. Coordinates are those of the clouds [m].");
  bind_building(bound);
  bound
      .def_prop_ro(
          "resolution_m", [](const Occupancy& of) { return of.source->resolution_m(); },
          "Side of a cell [m].")
      .def_prop_ro(
          "crs", [](const Occupancy& of) { return of.source->crs(); },
          "Coordinate reference system; empty if unknown.")
      .def_prop_ro("bounds", &bounds_in_source,
                   nb::sig("def bounds(self) -> numpy.typing.NDArray[numpy.float64] | None"),
                   "The least box around all that was measured: lower and upper corner (2, 3).")
      .def_prop_ro(
          "path",
          [](const Occupancy& of) -> std::optional<std::string> {
            if (of.file.empty()) return std::nullopt;
            return of.file.string();
          },
          "The file that holds it, if one does.")
      .def("cells", &cells_of,
           nb::sig("def cells(self) -> dict[str, numpy.typing.NDArray"
                   "[typing.Any]]"),
           "All leaves of the octree: `centre` (N, 3) [m], `size_m` (N), `occupied` (N), true or "
           "false: free.")
      .def("state_at", &states_at, nb::arg("points"),
           nb::sig("def state_at(self, points: numpy.typing.ArrayLike) -> "
                   "numpy.typing.NDArray[numpy.int8]"),
           "What was measured at points (N, 3): 1 occupied, 0 free, -1 unknown.")
      .def(
          "clearance",
          [](const Occupancy& of, nb::handle poses, nb::handle vehicle, double ground_m,
             double from_height_m, double within_m, bool unknown, int threads) {
            const geometry::VehicleShape shape = shape_of(vehicle);
            if (threads < 1) throw std::invalid_argument("threads: needs 1 or more");
            return clearance(
                of, poses,
                {shape,
                 {.from_m = ground_m + from_height_m, .to_m = ground_m + shape.height_m},
                 within_m,
                 unknown ? map::ObstacleKind::unknown : map::ObstacleKind::occupied,
                 threads});
          },
          nb::arg("poses"), nb::kw_only(), nb::arg("vehicle") = nb::none(),
          nb::arg("ground_m") = 0.0, nb::arg("from_height_m") = map::HeightBand{}.from_m,
          nb::arg("within_m") = kNothingNear, nb::arg("unknown") = false, nb::arg("threads") = 1,
          nb::sig("def clearance(self, poses: numpy.typing.ArrayLike, *, vehicle: Vehicle | str | "
                  "os.PathLike[str] | None = None, ground_m: float = 0.0, from_height_m: float = "
                  "0.2, within_m: float = float('inf'), unknown: bool = False, threads: int = 1) "
                  "-> numpy.typing.NDArray[numpy.float64]"),
          "Distance in plan between the vehicle's rectangle at each of (N, 3) poses x, y, heading, "
          "and the nearest occupied cell at its heights [m]: exact, 0 on overlap, infinite where "
          "none is within `within_m` or the field's horizon (1 km).\n\n"
          "ground_m: height of level ground; from_height_m: the vehicle's underside above it; "
          "unknown: distance to space that was not measured instead.")
      .def("__repr__", [](const Occupancy& of) {
        return fmt::format("<Occupancy: cells of {:g} m>", of.source->resolution_m());
      });
}

}  // namespace roadbed::tools::python
