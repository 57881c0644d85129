#include "roadbed/tools/commands/routes/route_output.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/files/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/planning/route/guidance.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_path.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

const char* word(planning::LegExit exit) {
  switch (exit) {
    case planning::LegExit::goal:
      return "goal";
    case planning::LegExit::successor:
      return "successor";
    case planning::LegExit::change_left:
      return "change_left";
    case planning::LegExit::change_right:
      return "change_right";
  }
  return "";
}

const char* word(planning::Turn turn) {
  switch (turn) {
    case planning::Turn::none:
      return "none";
    case planning::Turn::straight:
      return "straight";
    case planning::Turn::left:
      return "left";
    case planning::Turn::right:
      return "right";
    case planning::Turn::u_turn:
      return "u_turn";
  }
  return "";
}

const char* word(planning::Sense sense) {
  switch (sense) {
    case planning::Sense::either:
      return "either";
    case planning::Sense::along:
      return "along";
    case planning::Sense::against:
      return "against";
  }
  return "";
}

Json leg_json(const map::RoadMap& road_map, const planning::RouteLeg& leg,
              Coordinates coordinates) {
  Json json = {{"lane", road_map.lane(leg.lane).name},
               {"from_s_m", leg.from_s_m},
               {"to_s_m", leg.to_s_m},
               {"reversed", leg.reversed},
               {"exit", word(leg.exit)},
               {"turn", word(leg.turn)},
               {"length_m", leg.length_m},
               {"cost_s", leg.cost_s},
               {"cost_m", leg.cost_m},
               {"speed_limit_known", leg.limit_known}};
  if (leg.change_window) {
    json["change_from_s_m"] = leg.change_window->from_s_m;
    json["change_to_s_m"] = leg.change_window->to_s_m;
  }
  if (coordinates == Coordinates::lon_lat) {
    add_lon_lat(road_map, leg.lane, leg.from_s_m, leg.to_s_m, json);
  }
  return json;
}

Json crs_json(const map::RoadMap& road_map) {
  if (road_map.crs().empty()) return {};
  return Json{{"type", "name"}, {"properties", {{"name", road_map.crs()}}}};
}

std::vector<Eigen::Vector2d> way_of(const map::RoadMap& road_map, const planning::Route& route) {
  std::vector<Eigen::Vector2d> way;
  const auto path = planning::path_along(road_map, route, {.lead_m = 0.0, .extend_m = 0.0});
  for (const planning::RoutePathPoint& point : path.points) way.push_back(point.in_map);
  return way;
}

Json points_json(const map::RoadMap& road_map, std::vector<Eigen::Vector2d> points,
                 Coordinates coordinates) {
  for (Eigen::Vector2d& point : points) point = road_map.to_source(point);
  if (coordinates == Coordinates::lon_lat) map::source_to_lon_lat(road_map, points);
  Json json = Json::array();
  for (const Eigen::Vector2d& point : points) json.push_back({point.x(), point.y()});
  return json;
}

Json ring_json(const map::RoadMap& road_map, geometry::Ring ring, Coordinates coordinates) {
  if (!ring.empty()) ring.push_back(ring.front());
  return points_json(road_map, std::move(ring), coordinates);
}

Json area_feature(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                  const Json& properties, Coordinates coordinates) {
  Json polygons = Json::array();
  for (const geometry::Polygon& polygon : area) {
    Json rings = Json::array({ring_json(road_map, polygon.outer, coordinates)});
    for (const geometry::Ring& hole : polygon.holes) {
      rings.push_back(ring_json(road_map, hole, coordinates));
    }
    polygons.push_back(std::move(rings));
  }
  return {{"type", "Feature"},
          {"geometry", {{"type", "MultiPolygon"}, {"coordinates", std::move(polygons)}}},
          {"properties", properties}};
}

/// GeoJSON without `crs` is in longitude and latitude.
std::string collection(const map::RoadMap& road_map, Json features, Coordinates coordinates) {
  Json json = {{"type", "FeatureCollection"}};
  if (coordinates == Coordinates::source) json["crs"] = crs_json(road_map);
  json["features"] = std::move(features);
  return text_of(json, -1) + "\n";
}

struct Bounds {
  Eigen::Vector2d low{1e300, 1e300}, high{-1e300, -1e300};
  void add(const Eigen::Vector2d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

std::string lanes_around(const map::RoadMap& road_map, const map::SvgCanvas& canvas,
                         const Bounds& bounds) {
  std::string data;
  for (const map::LaneId id :
       road_map.index().lanes.in_box(bounds.low, bounds.high, map::LaneTypes::all())) {
    const map::Lane& lane = road_map.lane(id);
    const bool near =
        std::any_of(lane.polygon.begin(), lane.polygon.end(), [&](const Eigen::Vector2d& point) {
          return (point.array() >= bounds.low.array()).all() &&
                 (point.array() <= bounds.high.array()).all();
        });
    if (near && map::is_surface(lane.type)) data += canvas.ring(lane.polygon);
  }
  return data;
}

}  // namespace

std::string text_of(const Json& json, int indent) { return map::json_text(json, indent); }

void declare_lon_lat(Arguments& arguments, bool& wants_lon_lat) {
  arguments.flag("--lonlat", wants_lon_lat,
                 "Say longitude and latitude (WGS 84, degrees) as well: keys and columns lon_deg, "
                 "lat_deg; GeoJSON in these alone. The map has to name its coordinate system");
}

Eigen::Vector2d lon_lat_of(const map::RoadMap& road_map, map::LaneId lane, double s_m) {
  Eigen::Vector2d point = road_map.to_source(road_map.lane(lane).pose_at(s_m).position());
  map::source_to_lon_lat(road_map, std::span(&point, 1));
  return point;
}

void add_lon_lat(const map::RoadMap& road_map, map::LaneId lane, double from_s_m, double to_s_m,
                 Json& json) {
  const Eigen::Vector2d from = lon_lat_of(road_map, lane, from_s_m);
  const Eigen::Vector2d to = lon_lat_of(road_map, lane, to_s_m);
  json["from_lon_deg"] = from.x();
  json["from_lat_deg"] = from.y();
  json["to_lon_deg"] = to.x();
  json["to_lat_deg"] = to.y();
}

std::string lon_lat_fields(const map::RoadMap& road_map, map::LaneId lane, double from_s_m,
                           double to_s_m) {
  const Eigen::Vector2d from = lon_lat_of(road_map, lane, from_s_m);
  const Eigen::Vector2d to = lon_lat_of(road_map, lane, to_s_m);
  return fmt::format(",{},{},{},{}", from.x(), from.y(), to.x(), to.y());
}

Json route_json(const map::RoadMap& road_map, const planning::Route& route,
                Coordinates coordinates) {
  Json lanes = Json::array(), told = Json::array(), stops = Json::array();
  for (const planning::RouteLeg& leg : route.legs) {
    lanes.push_back(leg_json(road_map, leg, coordinates));
  }
  for (const planning::Instruction& step : planning::instructions_for(road_map, route)) {
    told.push_back({{"at_m", step.at_m},
                    {"lane", road_map.lane(route.legs[step.leg].lane).name},
                    {"text", step.text}});
  }
  for (const planning::RouteStop& stop : route.stops) {
    stops.push_back({{"lane", road_map.lane(route.legs[stop.leg].lane).name}, {"s_m", stop.s_m}});
  }
  return {{"found", true},
          {"cost_s", route.cost_s},
          {"cost_m", route.cost_m},
          {"length_m", route.length_m},
          {"lanes", std::move(lanes)},
          {"lane_changes", route.lane_changes},
          {"legs_of_unknown_speed", route.legs_of_unknown_speed},
          {"via", std::move(stops)},
          {"instructions", std::move(told)}};
}

Json no_route_json(const map::RoadMap& road_map, const planning::RouteAnswer& answer) {
  Json json = {{"found", false}, {"reason", answer.reason}, {"failed_part", answer.failed_part}};
  if (!answer.explanation) return json;
  const planning::NoRouteExplanation& explanation = *answer.explanation;
  const auto lane_name = [&](const std::optional<map::LaneId>& lane) {
    return lane ? Json(road_map.lane(*lane).name) : Json();
  };
  json["lanes_from_start"] = explanation.lanes_from_start;
  json["lanes_to_goal"] = explanation.lanes_to_goal;
  json["gap_m"] = explanation.gap_from ? Json(explanation.gap_m) : Json();
  json["gap_from_lane"] = lane_name(explanation.gap_from);
  json["gap_to_lane"] = lane_name(explanation.gap_to);
  json["blocking_rules"] = Json::array();
  for (const auto rule : explanation.blocking_rules)
    json["blocking_rules"].push_back(planning::to_string(rule));
  json["blocked_from_lane"] = lane_name(explanation.blocked_from);
  json["blocked_to_lane"] = lane_name(explanation.blocked_to);
  return json;
}

Json place_json(const map::RoadMap& road_map, const Place& place) {
  Json candidates = Json::array();
  for (const planning::PlaceCandidate& candidate : place.candidates) {
    candidates.push_back({{"lane", road_map.lane(candidate.place.lane).name},
                          {"s_m", candidate.place.s_m},
                          {"d_m", candidate.place.d_m},
                          {"distance_m", candidate.distance_m},
                          {"heading_rad", candidate.heading_rad},
                          {"sense", word(candidate.sense)},
                          {"misfit_m", candidate.misfit_m},
                          {"verdict", planning::to_string(candidate.verdict)}});
  }
  return {{"lane", road_map.lane(place.on_lane.lane).name},
          {"s_m", place.on_lane.s_m},
          {"candidates", std::move(candidates)}};
}

std::string route_geojson(const map::RoadMap& road_map, const std::vector<planning::Route>& routes,
                          Coordinates coordinates) {
  Json features = Json::array();
  for (const planning::Route& route : routes) {
    Json line = points_json(road_map, way_of(road_map, route), coordinates);
    Json properties = route_json(road_map, route, coordinates);
    properties["kind"] = "way";
    features.push_back({{"type", "Feature"},
                        {"geometry", {{"type", "LineString"}, {"coordinates", std::move(line)}}},
                        {"properties", std::move(properties)}});
  }
  for (const planning::Route& route : routes) {
    const auto area = planning::area_of(road_map, planning::corridor_of(road_map, route));
    features.push_back(area_feature(road_map, area, {{"kind", "corridor"}}, coordinates));
  }
  return collection(road_map, std::move(features), coordinates);
}

std::string area_geojson(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                         const Json& properties, Coordinates coordinates) {
  return collection(road_map, Json::array({area_feature(road_map, area, properties, coordinates)}),
                    coordinates);
}

std::string route_csv(const map::RoadMap& road_map, const std::vector<planning::Route>& routes,
                      Coordinates coordinates) {
  const bool has_lon_lat = coordinates == Coordinates::lon_lat;
  std::string text = fmt::format(
      "route,leg,lane,from_s_m,to_s_m,exit,turn,change_from_s_m,change_to_s_m,length_m,cost_s,"
      "cost_m,speed_limit_known,reversed{}\n",
      has_lon_lat ? kLonLatColumns : "");
  for (std::size_t i = 0; i < routes.size(); ++i) {
    for (std::size_t j = 0; j < routes[i].legs.size(); ++j) {
      const planning::RouteLeg& leg = routes[i].legs[j];
      const std::string window =
          leg.change_window
              ? fmt::format("{:.3f},{:.3f}", leg.change_window->from_s_m, leg.change_window->to_s_m)
              : ",";
      text += fmt::format("{},{},{},{:.3f},{:.3f},{},{},{},{:.3f},{:.4f},{:.4f},{},{}", i, j,
                          map::csv_field(road_map.lane(leg.lane).name), leg.from_s_m, leg.to_s_m,
                          word(leg.exit), word(leg.turn), window, leg.length_m, leg.cost_s,
                          leg.cost_m, leg.limit_known ? 1 : 0, leg.reversed ? 1 : 0);
      if (has_lon_lat) text += lon_lat_fields(road_map, leg.lane, leg.from_s_m, leg.to_s_m);
      text += '\n';
    }
  }
  return text;
}

std::string area_svg(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                     const std::vector<planning::Route>& routes) {
  constexpr double kMargin_m = 30.0;
  Bounds bounds;
  for (const geometry::Polygon& polygon : area) {
    for (const Eigen::Vector2d& point : polygon.outer) bounds.add(point);
  }
  bounds.low.array() -= kMargin_m;
  bounds.high.array() += kMargin_m;
  map::SvgCanvas canvas({bounds.low.x(), bounds.high.y()}, 0.05);
  const Eigen::Vector2d size_m = bounds.high - bounds.low;
  const double stroke_m = std::max(0.6, 0.003 * size_m.maxCoeff());
  canvas.add_path(lanes_around(road_map, canvas, bounds),
                  "fill=\"#d9dce1\" stroke=\"#fff\" stroke-width=\".2\"");
  canvas.add_path(canvas.region(area), "fill=\"#f2b33d\" fill-opacity=\".7\"");
  constexpr const char* kColours[] = {"#1456c8", "#a3229b", "#0a7d5a", "#b03a12", "#555"};
  for (std::size_t i = 0; i < routes.size(); ++i) {
    const auto way = way_of(road_map, routes[i]);
    canvas.add_path(canvas.line(way),
                    fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\"",
                                kColours[i % std::size(kColours)], stroke_m));
    const auto dot = [&](const Eigen::Vector2d& in_map, const char* colour) {
      const Eigen::Vector2d at = canvas.to_picture(in_map);
      canvas.add(fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"{}\"/>\n",
                             at.x(), at.y(), 2.0 * stroke_m, colour));
    };
    dot(way.front(), "#0a7d0a");
    dot(way.back(), "#c01010");
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.2f} {:.2f}\" "
      "width=\"1000\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
      size_m.x(), size_m.y(), canvas.elements());
}

std::string route_text(const map::RoadMap& road_map, const planning::Route& route) {
  std::string text = fmt::format("{:.1f} m, {:.1f} s, {} lane changes\n", route.length_m,
                                 route.cost_s, route.lane_changes);
  for (const planning::RouteLeg& leg : route.legs) {
    text += fmt::format("  {:<16} {:>9.2f} to {:>9.2f} m {:>9.2f} s  {}\n",
                        road_map.lane(leg.lane).name, leg.from_s_m, leg.to_s_m, leg.cost_s,
                        word(leg.exit));
  }
  for (const planning::Instruction& step : planning::instructions_for(road_map, route)) {
    text += step.text + "\n";
  }
  return text;
}

void check_suffix(const std::filesystem::path& output, const std::string& suffix,
                  const std::vector<std::string>& suffixes) {
  if (std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end()) return;
  throw map::InputError({.file = output.string(),
                         .found = fmt::format("the suffix \"{}\" names no format", suffix),
                         .needed = fmt::format("{}", fmt::join(suffixes, ", ")),
                         .remedy = "rename the output"});
}

}  // namespace roadbed::tools::commands::routes
