#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/derived/lane_frame.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/points_csv.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

constexpr double kSearch_m[] = {5.0, 50.0, 500.0, 5e3, 5e4};

/// Of each point the nearest lanes first, at most `count`, searched ever farther until there is
/// one.
std::vector<std::vector<map::LaneMatch>> nearest_lanes(
    const map::RoadMap& road_map, const std::vector<Eigen::Vector2d>& points_in_map,
    std::size_t count, bool only_drivable) {
  std::vector<std::vector<map::LaneMatch>> nearest(points_in_map.size());
  std::vector<std::size_t> open(points_in_map.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (const double radius_m : kSearch_m) {
    std::vector<Eigen::Vector2d> points;
    for (const std::size_t i : open) points.push_back(points_in_map[i]);
    const auto matches = road_map.locate(points, radius_m, count, only_drivable);
    std::vector<std::size_t> still_open;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto found = matches.of(k);
      nearest[open[k]].assign(found.begin(), found.end());
      if (found.empty()) still_open.push_back(open[k]);
    }
    open = std::move(still_open);
  }
  return nearest;
}

Json match_json(const map::RoadMap& road_map, const map::LaneMatch& match,
                const Eigen::Vector2d& point_in_map) {
  const map::Lane& lane = road_map.lane(match.place.lane);
  const auto on_road = map::road_place(road_map, lane.id, point_in_map);
  Json json = {{"lane", lane.name}};
  json["road"] = lane.road ? Json(road_map.road(*lane.road).source_id) : Json();
  json["section"] = lane.origin.section;
  json["lane_id"] = lane.origin.source_id;
  json["type"] = to_string(lane.type);
  json["one_way"] = lane.one_way;
  json["s_m"] = match.place.s_m;
  json["d_m"] = match.place.d_m;
  json["distance_m"] = match.distance_m;
  json["heading_rad"] = match.heading_rad;
  json["road_s_m"] = on_road ? Json(on_road->s_m) : Json();
  json["road_t_m"] = on_road ? Json(on_road->t_m) : Json();
  return json;
}

/// @param lon_lat  of the point, null where it is not to be said.
Json located(const map::RoadMap& road_map, const Eigen::Vector2d& in_source,
             const Eigen::Vector2d* lon_lat, const std::vector<map::LaneMatch>& nearest) {
  Json lanes = Json::array();
  for (const auto& match : nearest) {
    lanes.push_back(match_json(road_map, match, road_map.to_map(in_source)));
  }
  Json point = {{"x_m", in_source.x()}, {"y_m", in_source.y()}};
  if (lon_lat != nullptr) {
    point["lon_deg"] = lon_lat->x();
    point["lat_deg"] = lon_lat->y();
  }
  point["lanes"] = std::move(lanes);
  return point;
}

void print_places(std::ostream& out, const Json& point) {
  fmt::print(out, "{:.3f},{:.3f}", point["x_m"].get<double>(), point["y_m"].get<double>());
  if (point.contains("lon_deg")) {
    fmt::print(out, "  lonlat:{:.9f},{:.9f}", point["lon_deg"].get<double>(),
               point["lat_deg"].get<double>());
  }
  fmt::print(out, "\n");
  const auto shown = [](const Json& value) {
    return value.is_null() ? std::string("-") : fmt::format("{:.3f}", value.get<double>());
  };
  if (!point["lanes"].empty()) {
    fmt::print(out, "  {:<16} {:<10} {:>10} {:>8} {:>9} {:>8} {:>10} {:>8}\n", "lane", "type",
               "s_m", "d_m", "away_m", "heading", "road_s_m", "road_t_m");
  }
  for (const Json& lane : point["lanes"]) {
    fmt::print(out, "  {:<16} {:<10} {:>10} {:>8} {:>9} {:>8} {:>10} {:>8}\n",
               lane["lane"].get<std::string>(), lane["type"].get<std::string>(), shown(lane["s_m"]),
               shown(lane["d_m"]), shown(lane["distance_m"]), shown(lane["heading_rad"]),
               shown(lane["road_s_m"]), shown(lane["road_t_m"]));
  }
}

class LocateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Find the lanes nearest to points");
    arguments.add("MAP", map_file_, "Any readable map").required().ending(kMapEndings);
    const Argument at =
        arguments
            .add("--at", at_, "Point X,Y in the map's coordinates [m], or lonlat:LON,LAT [deg]")
            .checked(point_syntax_fault);
    Argument points = arguments.add("--points", points_file_,
                                    "CSV file with columns x_m,y_m, or lon_deg,lat_deg");
    points.ending(".csv").excludes(at);
    arguments.add("--count", count_, "Most lanes to name per point").positive().with_default();
    arguments.flag("--drivable", only_drivable_, "Only lanes that a car may drive on");
    arguments.flag("--lonlat", wants_lon_lat_,
                   "Say the points' longitude and latitude (WGS 84) as well; the map has to name "
                   "its coordinate system");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.require([this] {
      return at_.empty() && points_file_.empty() ? std::string("--at or --points is required")
                                                 : std::string();
    });
    arguments.says_no_if("a point has no lane within 50 km");
    arguments.example("  roadbed locate town.xodr --at 20,-1.8");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    const map::RoadMap road_map = map::load_map(map_file_);
    const std::vector<Eigen::Vector2d> in_source = points(road_map);
    std::vector<Eigen::Vector2d> lon_lat;
    if (wants_lon_lat_) {
      lon_lat = in_source;
      map::source_to_lon_lat(road_map, lon_lat);
    }
    const auto [head, tail] = around_answers();
    if (json_) streams.out << head;
    bool all_found = true;
    for (std::size_t from = 0; from < in_source.size(); from += kPointsAtOnce) {
      all_found = answer(road_map, in_source, lon_lat, from, streams.out) && all_found;
    }
    if (json_) streams.out << tail;
    if (!all_found) fmt::print(streams.err, "roadbed: a point has no lane within 50 km\n");
    return all_found ? Exit::ok : Exit::no;
  }

 private:
  // Answers take some kilobytes a point, and are printed before the next ones are looked for.
  static constexpr std::size_t kPointsAtOnce = 1000;

  // The document of all answers before the first one and behind the last one.
  static std::pair<std::string, std::string> around_answers() {
    const std::string document =
        map::json_text(versioned("locate", {{"points", Json::array({nullptr})}}), 2);
    const std::size_t at = document.find("null");
    return {document.substr(0, at), document.substr(at + 4) + '\n'};
  }

  // Of the points from one on; returns whether each of them has a lane.
  bool answer(const map::RoadMap& road_map, const std::vector<Eigen::Vector2d>& in_source,
              const std::vector<Eigen::Vector2d>& lon_lat, std::size_t from,
              std::ostream& out) const {
    const std::size_t to = std::min(in_source.size(), from + kPointsAtOnce);
    std::vector<Eigen::Vector2d> in_map;
    for (std::size_t i = from; i < to; ++i) in_map.push_back(road_map.to_map(in_source[i]));
    const auto nearest = nearest_lanes(road_map, in_map, count_, only_drivable_);
    bool all_found = true;
    for (std::size_t i = from; i < to; ++i) {
      const Json found = located(road_map, in_source[i], wants_lon_lat_ ? &lon_lat[i] : nullptr,
                                 nearest[i - from]);
      all_found = all_found && !found["lanes"].empty();
      json_ ? print_json(out, found, i == 0) : print_places(out, found);
    }
    return all_found;
  }

  static void print_json(std::ostream& out, const Json& found, bool is_first) {
    if (!is_first) out << ",\n    ";
    for (const char c : map::json_text(found, 2)) {
      out << c;
      if (c == '\n') out << "    ";  // as deep as it lies
    }
  }

  std::vector<Eigen::Vector2d> points(const map::RoadMap& road_map) const {
    if (points_file_.empty()) return {find_point(road_map, at_)};
    PointTable table = read_point_table(points_file_);
    if (table.is_lon_lat) map::lon_lat_to_source(road_map, table.points);
    return std::move(table.points);
  }

  std::filesystem::path map_file_, points_file_;
  std::string at_;
  std::size_t count_ = 5;
  bool only_drivable_ = false, json_ = false, wants_lon_lat_ = false;
};

}  // namespace

std::unique_ptr<Command> make_locate_command() { return std::make_unique<LocateCommand>(); }

}  // namespace roadbed::tools::commands::maps
