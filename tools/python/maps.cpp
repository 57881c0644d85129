#include <fmt/format.h>
#include <nanobind/stl/pair.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/drivable_area.h"
#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/drawing/write_svg.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/gis/geopackage_content.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_options.h"
#include "roadbed/tools/commands/maps/finding_reports.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kPointsAtOnce = 1 << 17;
constexpr std::size_t kMostDrawnLanes = 5000;  // in a notebook, which keeps every picture

/// What `locate` found, a value for each point, or for each point and rank.
struct Located {
  RoadMapPointer road_map;
  std::size_t points = 0, count = 1;
  std::vector<std::int32_t> lane;
  std::vector<double> s_m, d_m, distance_m, heading_rad;

  Located(RoadMapPointer of, std::size_t asked, std::size_t most)
      : road_map(std::move(of)), points(asked), count(most) {
    lane.assign(points * count, -1);
    for (std::vector<double>* values : {&s_m, &d_m, &distance_m, &heading_rad}) {
      values->assign(points * count, kNone);
    }
  }

  void take(std::size_t point, std::span<const map::LaneMatch> matches) {
    for (std::size_t rank = 0; rank < matches.size(); ++rank) {
      const std::size_t i = point * count + rank;
      lane[i] = static_cast<std::int32_t>(matches[rank].place.lane.index);
      s_m[i] = matches[rank].place.s_m;
      d_m[i] = matches[rank].place.d_m;
      distance_m[i] = matches[rank].distance_m;
      heading_rad[i] = matches[rank].heading_rad;
    }
  }
};

// N values, or N×count where more than one lane a point was asked for.
template <typename T>
nb::ndarray<nb::numpy, const T> column(nb::handle self, const std::vector<T> Located::*values) {
  const auto& located = nb::cast<const Located&>(self);
  const std::size_t shape[] = {located.points, located.count};
  return {(located.*values).data(), located.count == 1 ? std::size_t{1} : std::size_t{2}, shape,
          self};
}

struct LocateOptions {
  std::size_t count;
  double radius_m;
  bool drivable;
  int threads;
};

Located locate(const Map& map, const Rows& points, const LocateOptions& options) {
  const std::size_t size = points.shape(0);
  Located located(map.road_map, size, options.count);
  const nb::gil_scoped_release released;
  const std::size_t batch = options.threads == 1 ? std::max<std::size_t>(size, 1) : kPointsAtOnce;
  map::in_threads((size + batch - 1) / batch, options.threads, [&](std::size_t i) {
    const std::size_t from = i * batch, to = std::min(size, from + batch);
    std::vector<Eigen::Vector2d> in_map(to - from);
    for (std::size_t k = from; k < to; ++k) {
      in_map[k - from] = map.road_map->to_map({points.data()[2 * k], points.data()[2 * k + 1]});
    }
    const map::LaneMatches found =
        map.road_map->locate(in_map, options.radius_m, options.count, options.drivable);
    for (std::size_t k = from; k < to; ++k) located.take(k, found.of(k - from));
  });
  return located;
}

void bind_located(nb::module_& module) {
  nb::class_<Located>(module, "Located",
                      "The lanes nearest to points, as arrays of N values, or of (N, count) where "
                      "more than one lane a point was asked for, nearest first. Where there is no "
                      "lane `lane` is -1 and the others are NaN.")
      .def_prop_ro(
          "lane", [](nb::handle self) { return column(self, &Located::lane); },
          "Index of the lane in `Map.lanes`.")
      .def_prop_ro(
          "s_m", [](nb::handle self) { return column(self, &Located::s_m); },
          "Station along the lane's centreline in driving direction [m].")
      .def_prop_ro(
          "d_m", [](nb::handle self) { return column(self, &Located::d_m); },
          "Offset from the centreline, positive to the left [m].")
      .def_prop_ro(
          "distance_m", [](nb::handle self) { return column(self, &Located::distance_m); },
          "Distance to the lane, 0 inside it [m].")
      .def_prop_ro(
          "heading_rad", [](nb::handle self) { return column(self, &Located::heading_rad); },
          "Direction of the lane there [rad].")
      .def_prop_ro(
          "names",
          [](const Located& located) {
            std::vector<std::optional<std::string>> names;
            for (const std::int32_t lane : located.lane) {
              if (lane < 0) {
                names.emplace_back();
              } else {
                names.emplace_back(located.road_map->lanes()[static_cast<std::size_t>(lane)].name);
              }
            }
            return names;
          },
          "Names of the lanes, flat: N, or N · count of them; None where there is no lane.")
      .def("__len__", [](const Located& located) { return located.points; })
      .def("__repr__", [](const Located& located) {
        const auto found =
            std::ranges::count_if(located.lane, [](std::int32_t l) { return l >= 0; });
        return fmt::format("<Located: {} points, {} lanes>", located.points, found);
      });
}

std::string text_of(map::validation::Severity severity) {
  return std::string(map::validation::to_string(severity));
}

void bind_findings(nb::module_& module) {
  using map::validation::Finding;
  nb::class_<map::Validation>(module, "Validation",
                              "What `validate` found; true where no finding is an error.")
      .def_prop_ro(
          "findings",
          [](const map::Validation& validation) {
            return nb::cast<nb::list>(
                object_of(nlohmann::ordered_json::parse(findings_json(validation)))["findings"]);
          },
          nb::sig("def findings(self) -> list[dict[str, typing.Any]]"),
          "A dict for each: rule, asam_rule, autoware_issue, severity (error, warning, info), "
          "element, "
          "line, x_m, y_m and message, as in `roadbed validate --json`.")
      .def_prop_ro(
          "refusal", [](const map::Validation& validation) { return validation.refusal; },
          "Why the file cannot be read as a map; empty if it can.")
      .def(
          "count",
          [](const map::Validation& validation, const std::string& severity) {
            return std::ranges::count_if(validation.findings, [&](const Finding& finding) {
              return text_of(finding.severity) == severity;
            });
          },
          nb::arg("severity"), "How many findings are of a severity: error, warning or info.")
      .def("__len__", [](const map::Validation& validation) { return validation.findings.size(); })
      .def("__bool__",
           [](const map::Validation& validation) {
             return std::ranges::none_of(validation.findings, [](const Finding& finding) {
               return finding.severity == map::validation::Severity::error;
             });
           })
      .def("__str__",
           [](const map::Validation& validation) { return findings_text(validation, "map"); })
      .def("__repr__",
           [](const map::Validation& validation) {
             return fmt::format("<Validation: {} findings>", validation.findings.size());
           })
      .def(
          "_repr_svg_",
          [](const map::Validation& validation) -> std::optional<std::string> {
            if (!validation.road_map || validation.road_map->lanes().size() > kMostDrawnLanes) {
              return std::nullopt;
            }
            return findings_svg(validation);
          },
          "The map with its findings.");
  module.def(
      "validate",
      [](nb::handle path) {
        const std::filesystem::path file = path_of(path);
        const nb::gil_scoped_release released;
        return map::validate_file(file);
      },
      nb::arg("path"), nb::sig("def validate(path: str | os.PathLike[str]) -> Validation"),
      "Looks for every fault of a map file: of its text, and of the map that it makes.\n\n"
      "Raises InputError if the file is missing or of no known format.");
}

// Where the system is not known it may be anchored, as `roadbed export --anchor` does.
std::string system_of(const Map& map, const std::optional<std::string>& crs,
                      const std::optional<std::pair<double, double>>& anchor) {
  std::string own = crs ? *crs : map.road_map->crs();
  if (!anchor) return own;
  if (own.empty()) return map::system_anchored_at(anchor->first, anchor->second);
  throw map::InputError({.file = map.file.string(),
                         .found = fmt::format("the coordinate system is known: \"{}\"", own),
                         .needed = "a map of unknown system for an anchor",
                         .remedy = "leave the anchor out, or say crs=\"\" if it is wrong"});
}

struct SaveChoice {
  std::vector<std::string> layers;
  std::optional<std::string> crs;
  std::optional<std::pair<double, double>> anchor;
};

std::vector<std::string> save(const Map& map, const std::filesystem::path& file,
                              const SaveChoice& choice) {
  const nb::gil_scoped_release released;
  std::vector<std::string> notes;
  if (file.extension() == ".rbm") {
    const std::string network =
        planning::write_route_network(planning::route_network_of(*map.road_map));
    map::OutputFile output(file, true);
    map::write_compiled_map(*map.road_map, network, output);
    output.commit();
    return notes;
  }
  map::SaveOptions options;
  options.layers = choice.layers;
  options.crs = system_of(map, choice.crs, choice.anchor);
  options.is_own_crs = !choice.anchor && !choice.crs && !map.road_map->crs().empty();
  options.notes = &notes;
  map::save_map(*map.road_map, file, options);
  return notes;
}

// A layer's columns and its shapes as well-known binary, for GeoPandas.
nb::tuple layer_of(const Map& map, const std::string& name) {
  std::vector<map::Layer> layers;
  {
    const nb::gil_scoped_release released;
    layers.push_back(map::make_layer(*map.road_map, name));
    map::to_source(*map.road_map, layers);
    map::source_to_crs(*map.road_map, layers);
  }
  const map::Layer& layer = layers.front();
  nb::dict columns;
  for (std::size_t i = 0; i < layer.columns.size(); ++i) {
    nb::list values;
    for (const map::Feature& feature : layer.features) {
      values.append(std::visit(
          [](const auto& value) -> nb::object {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
              return nb::none();
            } else {
              return nb::cast(value);
            }
          },
          feature.values[i]));
    }
    columns[layer.columns[i].name.c_str()] = values;
  }
  constexpr std::size_t kHead = 40;  // of a GeoPackage's blob, with the box in plan
  nb::list shapes;
  for (const map::Feature& feature : layer.features) {
    const std::string blob = map::geopackage_blob(feature.shape, layer.shape, layer.has_z, 0);
    if (blob.empty()) {
      shapes.append(nb::none());
    } else {
      shapes.append(nb::bytes(blob.data() + kHead, blob.size() - kHead));
    }
  }
  return nb::make_tuple(columns, shapes);
}

nb::object bounds_of(const Map& map) {
  const auto bounds = map::totals_of(*map.road_map).bounds;
  if (!bounds) return nb::none();
  const Eigen::Vector2d low = map.road_map->to_source(bounds->low_in_map),
                        high = map.road_map->to_source(bounds->high_in_map);
  return nb::make_tuple(low.x(), low.y(), high.x(), high.y());
}

void bind_map_files(nb::class_<Map>& bound) {
  bound
      .def(
          "save",
          [](const Map& map, nb::handle path, std::vector<std::string> layers,
             std::optional<std::string> crs, std::optional<std::pair<double, double>> anchor) {
            return save(map, path_of(path), {std::move(layers), std::move(crs), anchor});
          },
          nb::arg("path"), nb::kw_only(), nb::arg("layers") = std::vector<std::string>(),
          nb::arg("crs") = nb::none(), nb::arg("anchor") = nb::none(),
          nb::sig("def save(self, path: str | os.PathLike[str], *, layers: "
                  "collections.abc.Sequence[str] = (), crs: str | None = None, anchor: "
                  "tuple[float, float] | None = None) -> list[str]"),
          "Writes the map in the format that the suffix names: .rbm (compiled), .geojson, .gpkg, "
          ".fgb, .svg, .csv, .osm, .xml, over what is there.\n\n"
          "layers: only these; crs: in place of what the map says itself; anchor: latitude and "
          "longitude of the origin [deg], where the system is unknown. Returns what is worth "
          "knowing, a line each.\n\n"
          "Raises InputError if the format cannot hold the map, OutputError if the file cannot be "
          "written.")
      .def(
          "to_geodataframe",
          [](nb::handle self, const std::string& layer) {
            return nb::module_::import_("roadbed._frames").attr("geodataframe")(self, layer);
          },
          nb::arg("layer") = "lanes",
          nb::sig("def to_geodataframe(self, layer: str = 'lanes') -> typing.Any"),
          "A layer as a GeoDataFrame, in the map's coordinate system if it is known. Needs "
          "geopandas.\n\nlayer: one of `roadbed.layers()`.")
      .def("_layer", &layer_of, nb::arg("name"),
           nb::sig("def _layer(self, name: str) -> tuple[dict[str, list[typing.Any]], "
                   "list[bytes | None]]"))
      .def(
          "svg",
          [](const Map& map) {
            const nb::gil_scoped_release released;
            return map::write_svg(*map.road_map);
          },
          "A picture of the map, as SVG text.")
      .def("_repr_svg_", [](const Map& map) -> std::optional<std::string> {
        if (map.road_map->lanes().size() > kMostDrawnLanes) return std::nullopt;
        return map::write_svg(*map.road_map);
      });
}

void bind_map_queries(nb::class_<Map>& bound) {
  bound
      .def(
          "locate",
          [](const Map& map, nb::handle points, std::size_t count, double radius_m, bool drivable,
             int threads) {
            if (count < 1) throw std::invalid_argument("count: 0, needs 1 or more");
            if (threads < 1) throw std::invalid_argument("threads: needs 1 or more");
            if (!(radius_m >= 0.0)) throw std::invalid_argument("radius_m: needs 0 or more");
            return locate(map, rows_of(points, "points", 2), {count, radius_m, drivable, threads});
          },
          nb::arg("points"), nb::kw_only(), nb::arg("count") = 1,
          nb::arg("radius_m") = std::numeric_limits<double>::infinity(),
          nb::arg("drivable") = false, nb::arg("threads") = 1,
          nb::sig("def locate(self, points: numpy.typing.ArrayLike, *, count: int = 1, radius_m: "
                  "float = float('inf'), drivable: bool = False, threads: int = 1) -> Located"),
          "The lanes nearest to points: an (N, 2) array of x and y [m].\n\n"
          "count: lanes a point; radius_m: farthest lane [m]; drivable: only lanes that a car may "
          "drive on. Inside lanes the one with the least |d| comes first.")
      .def(
          "lanes_in",
          [](const Map& map, double x_min, double y_min, double x_max, double y_max,
             bool drivable) {
            std::vector<std::int32_t> found;
            const Eigen::Vector2d low = map.road_map->to_map({x_min, y_min}),
                                  high = map.road_map->to_map({x_max, y_max});
            for (const map::LaneId id :
                 planning::lanes_touching(*map.road_map, geometry::box_ring(low, high))) {
              if (!drivable || map::is_drivable(map.road_map->lane(id).type)) {
                found.push_back(static_cast<std::int32_t>(id.index));
              }
            }
            return owned(std::move(found));
          },
          nb::arg("x_min"), nb::arg("y_min"), nb::arg("x_max"), nb::arg("y_max"), nb::kw_only(),
          nb::arg("drivable") = false, "Indices of the lanes that overlap a box [m].")
      .def(
          "edge_distance",
          [](const Map& map, nb::handle points) {
            const Rows rows = rows_of(points, "points", 2);
            std::vector<double> distances(rows.shape(0));
            {
              const nb::gil_scoped_release released;
              const map::DrivableArea area(*map.road_map);
              for (std::size_t i = 0; i < distances.size(); ++i) {
                distances[i] = area.signed_distance_m(
                    map.road_map->to_map({rows.data()[2 * i], rows.data()[2 * i + 1]}));
              }
            }
            return owned(std::move(distances));
          },
          nb::arg("points"),
          nb::sig("def edge_distance(self, points: numpy.typing.ArrayLike) -> "
                  "numpy.typing.NDArray[numpy.float64]"),
          "Distance from each of (N, 2) points to the edge of the drivable surface [m], negative "
          "off it. The surface is united anew at each call.");
}

}  // namespace

std::filesystem::path path_of(nb::handle path) {
  const nb::object bytes = nb::module_::import_("os").attr("fsencode")(path);
  return std::string(nb::cast<nb::bytes>(bytes).c_str());
}

void bind_maps(nb::module_& module) {
  bind_located(module);
  bind_findings(module);
  nb::class_<Map> bound(module, "Map",
                        "A digital road map. Coordinates are those of its file [m], everywhere.");
  bound
      .def_prop_ro(
          "format", [](const Map& map) { return map.road_map->format(); },
          "What it was read from: \"OpenDRIVE 1.4\", …")
      .def_prop_ro(
          "crs", [](const Map& map) { return map.road_map->crs(); },
          "Its coordinate reference system, as the file has it; empty if unknown.")
      .def_prop_ro(
          "lanes", [](const Map& map) { return Lanes{map.road_map}; },
          "The lanes, by index or by name.")
      .def_prop_ro("bounds", &bounds_of,
                   nb::sig("def bounds(self) -> "
                           "tuple[float, float, float, float] | None"),
                   "x_min, y_min, x_max and y_max of all lanes and areas [m].")
      .def_prop_ro(
          "path", [](const Map& map) { return map.file.string(); },
          "The file that it was read from.")
      .def("__repr__", [](const Map& map) {
        return fmt::format("<Map {}: {}, {} lanes, {} roads>", map.file.filename().string(),
                           map.road_map->format(), map.road_map->lanes().size(),
                           map.road_map->roads().size());
      });
  bind_map_queries(bound);
  bind_map_files(bound);
  module.def(
      "open",
      [](nb::handle path, double max_error_m) {
        const std::filesystem::path file = path_of(path);
        const nb::gil_scoped_release released;
        return std::make_unique<Map>(
            std::make_shared<const map::RoadMap>(map::load_map(file, {.max_error_m = max_error_m})),
            file);
      },
      nb::arg("path"), nb::kw_only(), nb::arg("max_error_m") = map::LoadOptions{}.max_error_m,
      nb::sig("def open(path: str | os.PathLike[str], *, max_error_m: float = 0.001) -> Map"),
      "Reads a map: OpenDRIVE, Lanelet2, CommonRoad, GeoJSON surfaces or a compiled map, told by "
      "content.\n\nmax_error_m: how far sampled borders may be from the true curve.\n\n"
      "Raises InputError if the file is missing or unusable.");
  module.def("layers", &map::layer_names, "Names of the layers that a map can be written in.");
}

}  // namespace roadbed::tools::python
