#include <fmt/format.h>
#include <nanobind/make_iterator.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/map/derived/lane_frame.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {
namespace {

/// A lane, which keeps its map alive.
struct LaneOfMap {
  RoadMapPointer road_map;
  map::LaneId id;

  const map::Lane& lane() const { return road_map->lane(id); }
};

Array2 line_array(const LaneOfMap& of, const map::LaneLine& line) {
  const Eigen::Vector2d& origin = of.road_map->origin_in_source();
  std::vector<double> values;
  values.reserve(3 * line.z_m.size());
  for (std::size_t i = 0; i < line.z_m.size(); ++i) {
    const Eigen::Vector2d& point = line.in_map.points()[i];
    values.insert(values.end(), {point.x() + origin.x(), point.y() + origin.y(), line.z_m[i]});
  }
  const std::size_t size = line.z_m.size();
  return owned<double, 2>(std::move(values), {size, 3});
}

template <map::LaneLine map::Lane::*kLine>
Array2 line_of(const LaneOfMap& of) {
  return line_array(of, of.lane().*kLine);
}

// A map's own memory.
template <map::LaneLine map::Lane::*kLine>
Array1 stations_of(nb::handle self) {
  const std::vector<double>& stations = (nb::cast<const LaneOfMap&>(self).lane().*kLine).station_m;
  const std::size_t shape[] = {stations.size()};
  return {stations.data(), 1, shape, self};
}

std::vector<std::string> names_of(const LaneOfMap& of, const std::vector<map::LaneId>& lanes) {
  std::vector<std::string> names;
  for (const map::LaneId id : lanes) names.push_back(of.road_map->lane(id).name);
  return names;
}

using NeighbourOfLane = std::optional<map::Neighbour> map::LaneLinks::*;

nb::object neighbour_of(const LaneOfMap& of, NeighbourOfLane side) {
  const std::optional<map::Neighbour>& neighbour = of.road_map->graph().of(of.id).*side;
  if (!neighbour) return nb::none();
  nb::list windows;
  for (const map::StationRange& window : neighbour->change_windows) {
    windows.append(nb::make_tuple(window.from_s_m, window.to_s_m));
  }
  nb::dict dict;
  dict["lane"] = of.road_map->lane(neighbour->lane).name;
  dict["same_direction"] = neighbour->same_direction;
  dict["change_windows_s_m"] = windows;
  return dict;
}

Array2 lane_to_xy(const LaneOfMap& of, nb::handle places) {
  const Rows rows = rows_of(places, "places", 2);
  const map::LaneFrame frame(of.lane());
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    points.push_back(frame.to_map(rows.data()[2 * i], rows.data()[2 * i + 1]));
  }
  return points_array(points, of.road_map->origin_in_source());
}

nb::object shapely_polygon(const LaneOfMap& of) {
  return nb::module_::import_("roadbed._frames")
      .attr("polygon")(points_array(of.lane().polygon, of.road_map->origin_in_source()));
}

LaneOfMap lane_at(const Lanes& lanes, long index) {
  const auto size = static_cast<long>(lanes.road_map->lanes().size());
  if (index < -size || index >= size) {
    throw nb::index_error(fmt::format("lane {} of {}", index, size).c_str());
  }
  return {lanes.road_map, {static_cast<std::uint32_t>(index < 0 ? index + size : index)}};
}

LaneOfMap lane_called(const Lanes& lanes, const std::string& name) {
  const auto id = lanes.road_map->find_lane(name);
  if (!id) throw nb::key_error(fmt::format("no lane \"{}\"", name).c_str());
  return {lanes.road_map, *id};
}

void bind_lane_geometry(nb::class_<LaneOfMap>& bound) {
  bound
      .def_prop_ro("centre", &line_of<&map::Lane::centre>, nb::rv_policy::reference,
                   "The centreline in driving direction: an (N, 3) array of x, y and z [m].")
      .def_prop_ro("left", &line_of<&map::Lane::left>, nb::rv_policy::reference,
                   "The left border, in the same way.")
      .def_prop_ro("right", &line_of<&map::Lane::right>, nb::rv_policy::reference,
                   "The right border, in the same way.")
      .def_prop_ro("centre_s_m", &stations_of<&map::Lane::centre>,
                   "Station of each point of the centreline [m].")
      .def_prop_ro("left_s_m", &stations_of<&map::Lane::left>,
                   "Station, on the centreline, of each point of the left border [m].")
      .def_prop_ro("right_s_m", &stations_of<&map::Lane::right>, "The same of the right border.")
      .def_prop_ro(
          "polygon",
          [](const LaneOfMap& of) {
            return points_array(of.lane().polygon, of.road_map->origin_in_source());
          },
          nb::rv_policy::reference,
          "The lane's area: the corners of a simple polygon, counter-clockwise, (N, 2) [m].")
      .def("to_xy", &lane_to_xy, nb::arg("places"),
           nb::sig("def to_xy(self, places: numpy.typing.ArrayLike) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Points (N, 2) of places beside the centreline: an (N, 2) array of s and d [m].")
      .def(
          "width_m", [](const LaneOfMap& of, double s_m) { return of.lane().width_m(s_m); },
          nb::arg("s_m"), "Distance between the borders at a station [m].")
      .def("to_shapely", &shapely_polygon, nb::sig("def to_shapely(self) -> typing.Any"),
           "The area as shapely.Polygon. Needs shapely.");
}

void bind_lane_links(nb::class_<LaneOfMap>& bound) {
  bound
      .def_prop_ro(
          "successors",
          [](const LaneOfMap& of) {
            return names_of(of, of.road_map->graph().of(of.id).successors);
          },
          "Names of the lanes that begin where this one ends.")
      .def_prop_ro(
          "predecessors",
          [](const LaneOfMap& of) {
            return names_of(of, of.road_map->graph().of(of.id).predecessors);
          },
          "Names of the lanes that end where this one begins.")
      .def_prop_ro(
          "left_neighbour",
          [](const LaneOfMap& of) { return neighbour_of(of, &map::LaneLinks::left); },
          nb::sig("def left_neighbour(self) -> dict[str, typing.Any] | None"),
          "The next lane across the left border: `lane`, its name; `same_direction`; "
          "`change_windows_s_m`, pairs of stations between which the marking may be crossed.")
      .def_prop_ro(
          "right_neighbour",
          [](const LaneOfMap& of) { return neighbour_of(of, &map::LaneLinks::right); },
          nb::sig("def right_neighbour(self) -> dict[str, typing.Any] | None"),
          "The same across the right border.");
}

void bind_lane(nb::module_& module) {
  nb::class_<LaneOfMap> bound(module, "Lane", "A strip between two borders, one way along.");
  bound
      .def_prop_ro(
          "index", [](const LaneOfMap& of) { return of.id.index; }, "Its place in `Map.lanes`.")
      .def_prop_ro(
          "name", [](const LaneOfMap& of) { return of.lane().name; },
          "Unique: \"road/section/lane\" of OpenDRIVE, else the source's id.")
      .def_prop_ro(
          "type", [](const LaneOfMap& of) { return std::string(to_string(of.lane().type)); },
          "What it is for: \"driving\", \"sidewalk\", …, in OpenDRIVE's words.")
      .def_prop_ro(
          "drivable", [](const LaneOfMap& of) { return map::is_drivable(of.lane().type); },
          "Whether a car may plan to drive along it.")
      .def_prop_ro(
          "one_way", [](const LaneOfMap& of) { return of.lane().one_way; },
          "False: may be driven in both directions.")
      .def_prop_ro(
          "road",
          [](const LaneOfMap& of) -> std::optional<std::string> {
            if (!of.lane().road) return std::nullopt;
            return of.road_map->road(*of.lane().road).source_id;
          },
          "The source's id of its road; None in Lanelet2 and CommonRoad.")
      .def_prop_ro(
          "in_junction", [](const LaneOfMap& of) { return of.lane().junction.has_value(); },
          "Whether it leads through a junction.")
      .def_prop_ro(
          "length_m", [](const LaneOfMap& of) { return of.lane().length_m(); },
          "Length of the centreline [m].")
      .def_prop_ro(
          "speed_limits",
          [](const LaneOfMap& of) {
            std::vector<std::pair<double, std::optional<double>>> limits;
            for (const map::SpeedLimit& limit : of.lane().speed_limits) {
              limits.emplace_back(limit.from_s_m, limit.limit_mps);
            }
            return limits;
          },
          "Pairs of the station from which a limit holds [m] and the limit [m/s], inf where there "
          "is none, None where the source says nothing.")
      .def_prop_ro(
          "attributes",
          [](const LaneOfMap& of) {
            nb::dict attributes;
            for (const auto& [key, value] : of.lane().attributes) attributes[key.c_str()] = value;
            return attributes;
          },
          nb::sig("def attributes(self) -> dict[str, str]"),
          "What the source says of it beyond all that.")
      .def("__repr__", [](const LaneOfMap& of) {
        return fmt::format("<Lane {}: {}, {:.1f} m>", of.lane().name, to_string(of.lane().type),
                           of.lane().length_m());
      });
  bind_lane_geometry(bound);
  bind_lane_links(bound);
}

}  // namespace

void bind_lanes(nb::module_& module) {
  bind_lane(module);
  nb::class_<Lanes>(module, "Lanes", "The lanes of a map, by index or by name.")
      .def("__len__", [](const Lanes& lanes) { return lanes.road_map->lanes().size(); })
      .def("__getitem__", &lane_at, nb::arg("index"))
      .def("__getitem__", &lane_called, nb::arg("name"))
      .def("__contains__",
           [](const Lanes& lanes, const std::string& name) {
             return lanes.road_map->find_lane(name).has_value();
           })
      .def(
          "__iter__",
          [](nb::handle self) {
            return nb::module_::import_("roadbed._frames").attr("each")(self);
          },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[Lane]"))
      .def_prop_ro(
          "names",
          [](const Lanes& lanes) {
            std::vector<std::string> names;
            for (const map::Lane& lane : lanes.road_map->lanes()) names.push_back(lane.name);
            return names;
          },
          "Of all lanes, in order.")
      .def_prop_ro(
          "lengths_m",
          [](const Lanes& lanes) {
            std::vector<double> lengths;
            for (const map::Lane& lane : lanes.road_map->lanes())
              lengths.push_back(lane.length_m());
            return owned(std::move(lengths));
          },
          nb::rv_policy::reference, "Lengths of all centrelines, in order [m].")
      .def("__repr__", [](const Lanes& lanes) {
        return fmt::format("<Lanes: {}>", lanes.road_map->lanes().size());
      });
}

namespace {

PointPlace point_of_row(const Rows& rows, std::size_t i) {
  const double* const row = rows.data() + i * rows.shape(1);
  PointPlace point{{row[0], row[1]}, {}};
  if (rows.shape(1) == 3) point.heading_rad = row[2];
  return point;
}

bool is_table(nb::handle places) {
  return nb::hasattr(places, "ndim") && nb::cast<int>(places.attr("ndim")) == 2;
}

}  // namespace

Place AskedPlace::on(const map::RoadMap& road_map, map::Participant participant) const {
  return std::visit([&](const auto& place) { return find_place(road_map, place, participant); },
                    told);
}

AskedPlace place_of(nb::handle place) {
  if (nb::isinstance<nb::str>(place)) return {nb::cast<std::string>(place)};
  if (nb::isinstance<LaneOfMap>(place)) {
    return {"lane:" + nb::cast<const LaneOfMap&>(place).lane().name};
  }
  const Rows row = rows_of(place, "place", 2, 3);
  if (row.shape(0) != 1) throw std::invalid_argument("place: is many places, needs one");
  return {point_of_row(row, 0)};
}

std::vector<AskedPlace> places_of(nb::handle places) {
  std::vector<AskedPlace> found;
  if (is_table(places)) {
    const Rows rows = rows_of(places, "places", 2, 3);
    for (std::size_t i = 0; i < rows.shape(0); ++i) found.push_back({point_of_row(rows, i)});
    return found;
  }
  for (const nb::handle place : places) found.push_back(place_of(place));
  return found;
}

}  // namespace roadbed::tools::python
