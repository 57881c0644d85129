#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route.h"
#include "roadbed/planning/route_path.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/support/output_file.h"
#include "roadbed/tools/support/route_question.h"

namespace roadbed::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Names of sources are not always valid UTF-8; JSON has to be.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

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

Json found_json(const map::RoadMap& road_map, const planning::Route& route) {
  Json lanes = Json::array();
  for (const planning::RouteLeg& leg : route.legs) {
    lanes.push_back({{"lane", road_map.lane(leg.lane).name},
                     {"from_s_m", leg.from_s_m},
                     {"to_s_m", leg.to_s_m},
                     {"exit", word(leg.exit)}});
  }
  return {{"found", true},
          {"cost_s", route.cost_s},
          {"cost_m", route.cost_m},
          {"length_m", route.length_m},
          {"lanes", std::move(lanes)},
          {"lane_changes", route.lane_changes},
          {"legs_of_unknown_speed", route.legs_of_unknown_speed}};
}

Json none_json(const map::RoadMap& road_map, const planning::RouteAnswer& answer) {
  Json json = {{"found", false}, {"reason", answer.reason}};
  if (!answer.obstacle) return json;
  const planning::RouteObstacle& obstacle = *answer.obstacle;
  const auto lane_name = [&](const std::optional<map::LaneId>& lane) {
    return lane ? Json(road_map.lane(*lane).name) : Json();
  };
  json["lanes_from_start"] = obstacle.lanes_from_start;
  json["lanes_to_goal"] = obstacle.lanes_to_goal;
  json["gap_m"] = obstacle.gap_from ? Json(obstacle.gap_m) : Json();
  json["gap_from_lane"] = lane_name(obstacle.gap_from);
  json["gap_to_lane"] = lane_name(obstacle.gap_to);
  json["found_with_closed_lanes_open"] = obstacle.closed_lanes;
  json["found_across_all_markings"] = obstacle.markings;
  json["found_with_shorter_lane_changes"] = obstacle.length;
  return json;
}

/// The way as one line in source coordinates; see map::write_geojson for its `crs`.
std::string geojson(const map::RoadMap& road_map, const planning::Route& route) {
  const planning::RoutePath path =
      planning::path_along(road_map, route, {.lead_m = 0.0, .extend_m = 0.0});
  Json line = Json::array();
  for (const planning::RoutePathPoint& point : path.points) {
    const Eigen::Vector2d in_source = road_map.to_source(point.in_map);
    line.push_back({in_source.x(), in_source.y()});
  }
  Json crs = road_map.crs().empty()
                 ? Json()
                 : Json{{"type", "name"}, {"properties", {{"name", road_map.crs()}}}};
  const Json feature = {{"type", "Feature"},
                        {"geometry", {{"type", "LineString"}, {"coordinates", std::move(line)}}},
                        {"properties", found_json(road_map, route)}};
  return text_of({{"type", "FeatureCollection"},
                  {"crs", std::move(crs)},
                  {"features", Json::array({feature})}},
                 -1) +
         "\n";
}

void print(std::ostream& out, const map::RoadMap& road_map, const planning::Route& route) {
  fmt::print(out, "{:.1f} m, {:.1f} s, {} lane changes\n", route.length_m, route.cost_s,
             route.lane_changes);
  for (const planning::RouteLeg& leg : route.legs) {
    fmt::print(out, "  {:<16} {:>9.2f} to {:>9.2f} m  {}\n", road_map.lane(leg.lane).name,
               leg.from_s_m, leg.to_s_m, word(leg.exit));
  }
}

class RouteCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Find the cheapest route over lanes, or say why there is none");
    arguments.add("MAP", map_file_, "Any readable map").required();
    question_.declare(arguments);
    arguments.flag("--json", json_, "Print one JSON document");
    arguments.add("-o,--output", output_, "Write the way as GeoJSON too");
    arguments.flag("--force", force_, "Replace the output if it exists");
    arguments.example("  roadbed route town.xodr --from lane:1/0/-1@10 --to lane:7/0/1@55");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!output_.empty()) check_writable(output_, force_);
    const map::RoadMap road_map = map::load_map(map_file_);
    const RouteQuestion::Asked asked = question_.on(road_map);
    const planning::RouteAnswer answer =
        planning::find_route(road_map, asked.from.on_lane, asked.to.on_lane, asked.options);
    if (!answer.route) return refuse(streams, road_map, answer);
    if (!output_.empty()) write_output(output_, geojson(road_map, *answer.route));
    if (json_) {
      fmt::print(streams.out, "{}\n", text_of(found_json(road_map, *answer.route), 2));
    } else {
      print(streams.out, road_map, *answer.route);
    }
    if (!common.quiet && answer.route->legs_of_unknown_speed > 0) {
      fmt::print(streams.err, "note: {} of {} lanes give no speed limit, {:.1f} km/h was used\n",
                 answer.route->legs_of_unknown_speed, answer.route->legs.size(),
                 asked.options.default_speed_mps * 3.6);
    }
    return Exit::ok;
  }

 private:
  Exit refuse(const Streams& streams, const map::RoadMap& road_map,
              const planning::RouteAnswer& answer) const {
    if (json_) fmt::print(streams.out, "{}\n", text_of(none_json(road_map, answer), 2));
    fmt::print(streams.err, "roadbed: no route: {}\n", answer.reason);
    return Exit::failed;
  }

  std::filesystem::path map_file_, output_;
  RouteQuestion question_;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_route_command() { return std::make_unique<RouteCommand>(); }

}  // namespace roadbed::tools
