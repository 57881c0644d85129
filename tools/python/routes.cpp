#include "roadbed/tools/python/routes.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "roadbed/planning/route/alternatives.h"
#include "roadbed/planning/route/guidance.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_path.h"
#include "roadbed/tools/commands/routes/route_output.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline python {

Map::Map(RoadMapPointer made, std::filesystem::path from)
    : road_map(std::move(made)), file(std::move(from)), routers(std::make_unique<Routers>()) {}
Map::~Map() = default;

const planning::Route& RouteOfMap::route() const {
  if (answer.route) return *answer.route;
  throw std::invalid_argument("there is no route: " + answer.reason);
}

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostRouters = 8;

/// What can be reached from a place.
struct Reach {
  RoadMapPointer road_map;
  std::vector<planning::ReachedLane> lanes;
  bool by_time = true;

  std::vector<geometry::Polygon> area() const {
    std::vector<planning::LanePart> parts;
    for (const planning::ReachedLane& lane : lanes) parts.push_back(lane.part);
    return planning::area_of(*road_map, parts);
  }
};

std::shared_ptr<Map::Routers::Entry> router_of(const Map& map, const nb::kwargs& given,
                                               bool prepared) {
  const nb::object sorted = nb::module_::import_("builtins").attr("sorted")(given.attr("items")());
  const std::string key = nb::cast<std::string>(nb::repr(sorted)) + (prepared ? ", prepared" : "");
  planning::RouteOptions options = route_options(*map.road_map, given);
  const nb::gil_scoped_release released;
  const std::lock_guard lock(map.routers->mutex);
  auto& kept = map.routers->by_options;
  if (const auto found = kept.find(key); found != kept.end()) return found->second;
  if (kept.size() == kMostRouters) kept.clear();
  auto made =
      std::make_shared<Map::Routers::Entry>(planning::Router(*map.road_map, std::move(options)));
  if (prepared) made->router.prepare();
  return kept[key] = std::move(made);
}

planning::RoutePlace on_map(const planning::Router& router, const AskedPlace& place) {
  return place.on(router.road_map(), router.options().participant).for_route();
}

RouteOfMap route(const Map& map, nb::handle start, nb::handle goal, nb::handle via,
                 const nb::kwargs& given) {
  const auto entry = router_of(map, given, false);
  std::vector<AskedPlace> asked = places_of(via);
  asked.insert(asked.begin(), place_of(start));
  asked.push_back(place_of(goal));
  const nb::gil_scoped_release released;
  const std::lock_guard lock(entry->mutex);
  std::vector<planning::RoutePlace> places;
  for (const AskedPlace& place : asked) places.push_back(on_map(entry->router, place));
  return {map.road_map, entry->router.find(places)};
}

std::vector<RouteOfMap> routes(const Map& map, nb::handle starts, nb::handle goals,
                               const nb::kwargs& given) {
  const auto entry = router_of(map, given, true);
  const std::vector<AskedPlace> from = places_of(starts), to = places_of(goals);
  if (from.size() != to.size()) {
    throw std::invalid_argument(
        fmt::format("goals: {}, needs one for each of {} starts", to.size(), from.size()));
  }
  const nb::gil_scoped_release released;
  const std::lock_guard lock(entry->mutex);
  std::vector<RouteOfMap> found;
  found.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    planning::Router& router = entry->router;
    found.push_back({map.road_map, router.find(on_map(router, from[i]), on_map(router, to[i]))});
  }
  return found;
}

std::vector<RouteOfMap> alternatives(const Map& map, nb::handle start, nb::handle goal, int count,
                                     const nb::kwargs& given) {
  if (count < 1 || count > 20) {
    throw std::invalid_argument(fmt::format("count: {}, needs 1 to 20", count));
  }
  const auto entry = router_of(map, given, false);
  const AskedPlace from = place_of(start), to = place_of(goal);
  const nb::gil_scoped_release released;
  const std::lock_guard lock(entry->mutex);
  planning::Router& router = entry->router;
  std::vector<RouteOfMap> found;
  for (planning::Alternative& other : planning::find_alternatives(
           router, on_map(router, from), on_map(router, to), {.count = count})) {
    planning::RouteAnswer answer;
    answer.route = std::move(other.route);
    found.push_back({map.road_map, std::move(answer), other.shared});
  }
  return found;
}

Reach reach(const Map& map, nb::handle start, std::optional<double> within_s,
            std::optional<double> within_m, nb::kwargs given) {
  if (within_s.has_value() == within_m.has_value()) {
    throw std::invalid_argument("just one of within_s and within_m is needed");
  }
  if (given.contains("cost")) throw nb::type_error("cost: says within_s or within_m");
  given["cost"] = within_s ? "time" : "distance";
  const auto entry = router_of(map, given, false);
  const AskedPlace asked = place_of(start);
  const nb::gil_scoped_release released;
  const std::lock_guard lock(entry->mutex);
  const Place from = asked.on(*map.road_map, entry->router.options().participant);
  const std::string fault = entry->router.unfit(from.for_route(), "start");
  if (!fault.empty()) throw std::invalid_argument("nothing can be reached: " + fault);
  return {map.road_map,
          planning::isochrone(entry->router, from.for_route(), within_s ? *within_s : *within_m),
          within_s.has_value()};
}

Array2 path_of(const RouteOfMap& of, double step_m) {
  const planning::RoutePath path = planning::path_along(
      *of.road_map, of.route(), {.step_m = step_m, .lead_m = 0.0, .extend_m = 0.0});
  std::vector<Eigen::Vector2d> points;
  for (const planning::RoutePathPoint& point : path.points) points.push_back(point.in_map);
  return points_array(points, of.road_map->origin_in_source());
}

std::vector<geometry::Polygon> corridor_area(const RouteOfMap& of) {
  return planning::area_of(*of.road_map, planning::corridor_of(*of.road_map, of.route()));
}

nb::object document_of(const RouteOfMap& of) {
  if (!of.answer.route) {
    return object_of(versioned("route", no_route_json(*of.road_map, of.answer)));
  }
  nlohmann::ordered_json json = route_json(*of.road_map, *of.answer.route);
  if (of.shared_length_fraction > 0.0) json["shared_length_fraction"] = of.shared_length_fraction;
  return object_of(versioned("route", json));
}

std::string route_repr(const RouteOfMap& of) {
  if (!of.answer.route) return fmt::format("<Route: none, {}>", of.answer.reason);
  const planning::Route& route = *of.answer.route;
  return fmt::format("<Route: {:.1f} m, {:.1f} s, {} lanes, {} lane changes>", route.length_m,
                     route.cost_s, route.legs.size(), route.lane_changes);
}

template <double planning::Route::*kNumber>
double number_of(const RouteOfMap& of) {
  return of.answer.route ? (*of.answer.route).*kNumber : kNoNumber;
}

void bind_route_shapes(nb::class_<RouteOfMap>& bound) {
  bound
      .def("path", &path_of, nb::arg("step_m") = 0.5,
           "Points (N, 2) along the lanes' centrelines from start to goal, over at lane changes "
           "[m].")
      .def(
          "corridor",
          [](const RouteOfMap& of) {
            return polygons_list(corridor_area(of), of.road_map->origin_in_source());
          },
          nb::sig("def corridor(self) -> list[list[numpy.typing.NDArray[numpy.float64]]]"),
          "The area of its lanes: polygons, each a list of rings (N, 2), the outer one first.")
      .def(
          "reference_line",
          [](const RouteOfMap& of, double max_move_m) {
            const nb::gil_scoped_release released;
            return LineOfMap{of.road_map,
                             planning::ReferenceLine::along(*of.road_map, of.route(),
                                                            {.max_smoothing_m = max_move_m}),
                             of.road_map->origin_in_source()};
          },
          nb::kw_only(), nb::arg("max_move_m") = planning::ReferenceLineOptions{}.max_smoothing_m,
          "The smooth line to drive along it.\n\n"
          "max_move_m: largest distance from the centreline [m].")
      .def("_repr_svg_", [](const RouteOfMap& of) -> std::optional<std::string> {
        if (!of.answer.route) return std::nullopt;
        return area_svg(*of.road_map, corridor_area(of), {*of.answer.route});
      });
}

void bind_route(nb::module_& module) {
  nb::class_<RouteOfMap> bound(module, "Route",
                               "A way over lanes, true if there is one; else `reason` says why "
                               "not, numbers are NaN and lists are empty.");
  bound.def("__bool__", [](const RouteOfMap& of) { return of.answer.route.has_value(); })
      .def_prop_ro(
          "reason", [](const RouteOfMap& of) { return of.answer.reason; },
          "Why there is no route, in one line; empty if there is one.")
      .def_prop_ro("length_m", &number_of<&planning::Route::length_m>, "Along the centrelines [m].")
      .def_prop_ro("cost_s", &number_of<&planning::Route::cost_s>,
                   "Travel time at the limits, with what changes and turns cost [s].")
      .def_prop_ro("cost_m", &number_of<&planning::Route::cost_m>,
                   "Length, with what changes and turns cost [m].")
      .def_prop_ro(
          "lane_changes",
          [](const RouteOfMap& of) { return of.answer.route ? of.answer.route->lane_changes : 0; },
          "How many there are.")
      .def_prop_ro(
          "lanes",
          [](const RouteOfMap& of) {
            std::vector<std::string> names;
            if (!of.answer.route) return names;
            for (const planning::RouteLeg& leg : of.answer.route->legs) {
              names.push_back(of.road_map->lane(leg.lane).name);
            }
            return names;
          },
          "Names of the lanes that it drives along, in order.")
      .def_prop_ro(
          "instructions",
          [](const RouteOfMap& of) {
            std::vector<std::string> texts;
            if (!of.answer.route) return texts;
            for (const auto& step : planning::instructions_for(*of.road_map, *of.answer.route)) {
              texts.push_back(step.text);
            }
            return texts;
          },
          "What to do on the way, a line each.")
      .def_ro("shared_length_fraction", &RouteOfMap::shared_length_fraction,
              "Of an alternative: the greatest fraction of its length that it has in common with "
              "one before it.")
      .def("to_dict", &document_of, nb::sig("def to_dict(self) -> dict[str, typing.Any]"),
           "All of it, as `roadbed route --json` prints it: legs with stations, turns and costs, "
           "instructions; or what stands between start and goal.")
      .def("__str__",
           [](const RouteOfMap& of) {
             return of.answer.route ? route_text(*of.road_map, *of.answer.route)
                                    : "no route: " + of.answer.reason;
           })
      .def("__repr__", &route_repr);
  bind_route_shapes(bound);
}

template <typename Value, typename Get>
nb::ndarray<nb::numpy, const Value, nb::ndim<1>> column_of(const Reach& reach, Get get) {
  std::vector<Value> values;
  for (const planning::ReachedLane& lane : reach.lanes) values.push_back(get(lane));
  return owned(std::move(values));
}

void bind_reach(nb::module_& module) {
  using planning::ReachedLane;
  nb::class_<Reach>(module, "Reach", "What can be reached from a place: parts of lanes.")
      .def_prop_ro(
          "lane",
          [](const Reach& reach) {
            return column_of<std::int32_t>(reach, [](const ReachedLane& lane) {
              return static_cast<std::int32_t>(lane.part.lane.index);
            });
          },
          nb::rv_policy::reference, "Index of each lane in `Map.lanes`.")
      .def_prop_ro(
          "names",
          [](const Reach& reach) {
            std::vector<std::string> names;
            for (const ReachedLane& lane : reach.lanes) {
              names.push_back(reach.road_map->lane(lane.part.lane).name);
            }
            return names;
          },
          "Name of each lane.")
      .def_prop_ro(
          "from_s_m",
          [](const Reach& reach) {
            return column_of<double>(reach, [](const auto& lane) { return lane.part.from_s_m; });
          },
          nb::rv_policy::reference, "Station at which each lane is entered [m].")
      .def_prop_ro(
          "to_s_m",
          [](const Reach& reach) {
            return column_of<double>(reach, [](const auto& lane) { return lane.part.to_s_m; });
          },
          nb::rv_policy::reference,
          "Station up to which it is reached [m]; less, where it is driven against its direction.")
      .def_prop_ro(
          "cost",
          [](const Reach& reach) {
            return column_of<double>(reach, [](const auto& lane) { return lane.cost; });
          },
          nb::rv_policy::reference, "What it costs to get to each [s, or m where distance counts].")
      .def(
          "area",
          [](const Reach& reach) {
            return polygons_list(reach.area(), reach.road_map->origin_in_source());
          },
          nb::sig("def area(self) -> list[list[numpy.typing.NDArray[numpy.float64]]]"),
          "Polygons, each a list of rings (N, 2), the outer one first.")
      .def("__len__", [](const Reach& reach) { return reach.lanes.size(); })
      .def("__repr__",
           [](const Reach& reach) { return fmt::format("<Reach: {} lanes>", reach.lanes.size()); })
      .def("_repr_svg_",
           [](const Reach& reach) { return area_svg(*reach.road_map, reach.area(), {}); });
}

constexpr const char* kPlaces =
    "Places are (x, y) or (x, y, heading) [m, rad], \"lane:NAME@S\" or another text as on the "
    "command line, or a Lane, which is its start.";

}  // namespace

void bind_routes(nb::module_& module) {
  bind_route(module);
  bind_reach(module);
  const std::string about = std::string("\n\n") + kPlaces;
  auto bound = nb::borrow<nb::class_<Map>>(module.attr("Map"));
  bound
      .def("route", &route, nb::arg("start"), nb::arg("goal"), nb::arg("via") = nb::make_tuple(),
           nb::arg("options"),
           nb::sig("def route(self, start: typing.Any, goal: typing.Any, via: "
                   "collections.abc.Iterable[typing.Any] = (), *, " ROADBED_ROUTE_OPTIONS
                   ") -> Route"),
           ("The cheapest route, past `via` in their order, or why there is none." + about +
            "\n\ncost: what is to be least; avoid: what is closed, \"lane:NAME\", \"road:ID\" or "
            "\"polygon:X,Y,X,Y,X,Y\"; prices of changes, turns and lights are in the unit of the "
            "cost.\n\nRaises InputError for a place that is not on the map.")
               .c_str())
      .def("routes", &routes, nb::arg("starts"), nb::arg("goals"), nb::arg("options"),
           nb::sig("def routes(self, starts: collections.abc.Iterable[typing.Any], goals: "
                   "collections.abc.Iterable[typing.Any], *, " ROADBED_ROUTE_OPTIONS
                   ") -> list[Route]"),
           "The cheapest route from each start to its goal. The first call for a map and options "
           "takes longer: it makes an index that all later ones use. Of routes that cost the same "
           "it may take another one than `route`.")
      .def("alternatives", &alternatives, nb::arg("start"), nb::arg("goal"), nb::arg("count") = 3,
           nb::arg("options"),
           nb::sig("def alternatives(self, start: typing.Any, goal: typing.Any, count: int = 3, "
                   "*, " ROADBED_ROUTE_OPTIONS ") -> list[Route]"),
           "The cheapest route, then up to `count` - 1 others, none of which shares more than 70 % "
           "of its length with one before it or costs over 1.5 times the first. Empty if there is "
           "no route.")
      .def("reach", &reach, nb::arg("start"), nb::kw_only(), nb::arg("within_s") = nb::none(),
           nb::arg("within_m") = nb::none(), nb::arg("options"),
           nb::sig("def reach(self, start: typing.Any, *, within_s: float | None = None, within_m: "
                   "float | None = None, " ROADBED_ROUTE_OPTIONS ") -> Reach"),
           "What can be reached from a place within a time or a distance.");
}

}  // namespace roadbed::tools::python
