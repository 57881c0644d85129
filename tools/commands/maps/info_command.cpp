#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

double area_m2(const std::vector<geometry::Polygon>& polygons) {
  double sum_m2 = 0.0;
  for (const geometry::Polygon& polygon : polygons) sum_m2 += geometry::area_m2(polygon);
  return sum_m2;
}

Json lane_counts(const map::MapTotals& totals) {
  Json json = Json::object();
  for (std::size_t i = 0; i < totals.lanes_of_type.size(); ++i) {
    const std::uint64_t count = totals.lanes_of_type[i];
    if (count > 0) json[std::string(to_string(static_cast<map::LaneType>(i)))] = count;
  }
  return json;
}

Json remark_counts(const map::MapTotals& totals) {
  Json json = Json::object();
  for (const auto& [rule, count] : totals.remarks) json[rule] = count;
  return json;
}

/// By exact unions where the totals have none.
map::MapAreas areas_of(const map::RoadMap& road_map, const map::MapTotals& totals) {
  if (totals.areas) return *totals.areas;
  map::MapAreas areas{.drivable_m2 = area_m2(map::drivable_surface(road_map))};
  for (const map::Junction& junction : road_map.junctions()) {
    areas.junctions_m2 += area_m2(map::junction_surface(road_map, junction.id));
  }
  return areas;
}

/// Road areas without lanes: their joint area, and the lines in the middle of them.
Json road_areas_json(const map::RoadMap& road_map) {
  double length_m = 0.0, width_m2 = 0.0;
  for (const geometry::MedialBranch& branch : map::road_centrelines(road_map)) {
    const std::vector<double>& s_m = branch.line.stations_m();
    length_m += branch.line.length_m();
    for (std::size_t i = 0; i + 1 < s_m.size(); ++i) {
      width_m2 += 0.5 * (branch.width_m[i] + branch.width_m[i + 1]) * (s_m[i + 1] - s_m[i]);
    }
  }
  return {{"areas", road_map.areas().size()},
          {"area_m2", area_m2(map::road_area_surface(road_map))},
          {"centrelines_m", length_m},
          {"mean_width_m", length_m > 0.0 ? Json(width_m2 / length_m) : Json()}};
}

Json map_bounds_json(const map::RoadMap& road_map, const map::MapTotals& totals) {
  if (!totals.bounds) return nullptr;
  const Eigen::Vector2d low = road_map.to_source(totals.bounds->low_in_map);
  const Eigen::Vector2d high = road_map.to_source(totals.bounds->high_in_map);
  return {{"min_x_m", low.x()}, {"min_y_m", low.y()}, {"max_x_m", high.x()}, {"max_y_m", high.y()}};
}

// By name each once; adding to an ordered object looks through all members for the name.
Json unused_counts(const map::RoadMap& road_map) {
  std::map<std::string, std::size_t> counts;
  for (const map::UnusedContent& unused : road_map.unused()) counts[unused.name] = unused.count;
  Json::object_t members;
  for (const auto& [name, count] : counts) members.push_back({name, count});
  return members;
}

Json info_json(const map::RoadMap& road_map) {
  const map::MapTotals totals = map::totals_of(road_map);
  const map::MapAreas areas = areas_of(road_map, totals);
  Json info;
  info["format"] = road_map.format();
  info["crs"] = road_map.crs().empty() ? Json() : Json(road_map.crs());
  info["roads"] = road_map.roads().size();
  info["junctions"] = road_map.junctions().size();
  info["signals"] = road_map.signals().size();
  info["controllers"] = road_map.controllers().size();
  info["stop_lines"] = road_map.stop_lines().size();
  info["regulations"] = road_map.regulations().size();
  info["objects"] = road_map.objects().size();
  info["areas_without_lanes"] = road_map.areas().size();
  info["lanes"] = road_map.lanes().size();
  info["lanes_by_type"] = lane_counts(totals);
  info["lengths"] = {{"roads_m", totals.roads_m}, {"drivable_lanes_m", totals.drivable_lanes_m}};
  info["areas"] = {{"drivable_m2", areas.drivable_m2}, {"junctions_m2", areas.junctions_m2}};
  info["bounds"] = map_bounds_json(road_map, totals);
  if (totals.has_road_areas) info["road_areas"] = road_areas_json(road_map);
  info["drivable_component_lanes"] = totals.component_lanes;
  info["remarks"] = remark_counts(totals);
  info["unused"] = unused_counts(road_map);
  return info;
}

Json verified_json(const map::VerifiedMap& verified) {
  return {{"chunks", verified.chunks}, {"records", verified.records}};
}

/// "12 driving, 3 sidewalk"
std::string names_listed(const Json& counts) {
  std::string text;
  for (const auto& [key, count] : counts.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.get<int>(), key);
  }
  return text.empty() ? "none" : text;
}

std::string map_bounds_text(const Json& bounds) {
  if (bounds.is_null()) return "none";
  const auto at = [&](const char* key) { return bounds.at(key).get<double>(); };
  return fmt::format("x {:.3f} to {:.3f} m, y {:.3f} to {:.3f} m", at("min_x_m"), at("max_x_m"),
                     at("min_y_m"), at("max_y_m"));
}

std::string components_text(const Json& sizes) {
  if (sizes.size() < 2) return fmt::format("{}", sizes.size());
  return fmt::format("{}, the largest with {} lanes", sizes.size(), sizes.at(0).get<int>());
}

std::string scenario_text(const Json& scenario) {
  const auto count = [&](const char* key) { return scenario.at(key).get<int>(); };
  return fmt::format(
      "{}: {} static, {} dynamic, {} other obstacles, {:.1f} s recorded, {} planning problems",
      scenario.at("benchmark_id").get<std::string>(), count("static_obstacles"),
      count("dynamic_obstacles"), count("other_obstacles"), scenario.at("recorded_s").get<double>(),
      count("planning_problems"));
}

void print_info(std::ostream& out, const Json& info) {
  const auto line = [&](const char* what, const std::string& value) {
    fmt::print(out, "{:<22}{}\n", what, value);
  };
  const auto number = [](const Json& json) { return json.get<double>(); };
  line("format", info.at("format").get<std::string>());
  line("crs", info.at("crs").is_null() ? "unknown" : info.at("crs").get<std::string>());
  line("bounds", map_bounds_text(info.at("bounds")));
  line("roads", fmt::format("{}, {:.1f} m", info.at("roads").get<int>(),
                            number(info.at("lengths").at("roads_m"))));
  line("junctions", fmt::format("{}, {:.1f} m²", info.at("junctions").get<int>(),
                                number(info.at("areas").at("junctions_m2"))));
  const auto count = [&](const char* key) { return info.at(key).get<int>(); };
  line("signals", fmt::format("{}, {} controllers, {} stop lines, {} regulations", count("signals"),
                              count("controllers"), count("stop_lines"), count("regulations")));
  line("objects",
       fmt::format("{}, {} areas without lanes", count("objects"), count("areas_without_lanes")));
  line("lanes",
       fmt::format("{}: {}", info.at("lanes").get<int>(), names_listed(info.at("lanes_by_type"))));
  line("drivable lanes",
       fmt::format("{:.1f} m, {:.1f} m²", number(info.at("lengths").at("drivable_lanes_m")),
                   number(info.at("areas").at("drivable_m2"))));
  if (info.contains("road_areas")) {
    const Json& areas = info.at("road_areas");
    line("road areas",
         fmt::format("{}, {:.1f} m², {:.1f} m of centrelines", areas.at("areas").get<int>(),
                     number(areas.at("area_m2")), number(areas.at("centrelines_m"))));
  }
  line("connected components", components_text(info.at("drivable_component_lanes")));
  line("remarks", names_listed(info.at("remarks")));
  if (info.contains("verified")) {
    line("verified", fmt::format("{} chunks, {} records", info["verified"]["chunks"].get<int>(),
                                 info["verified"]["records"].get<int>()));
  }
  line("not used", names_listed(info.at("unused")));
  if (info.contains("scenario") && info.at("scenario").is_object()) {
    line("scenario", scenario_text(info.at("scenario")));
  }
}

/// What a CommonRoad file holds beyond its map: time step, obstacles by role, planning problems;
/// null for any other file.
/// @throws InputError if the scenario is unusable.
Json scenario_counts(const std::string& bytes, const std::string& name) {
  namespace commonroad = map::commonroad;
  const map::Format* format = map::format_of(bytes);
  if (format == nullptr || format->name != "CommonRoad") return nullptr;
  const commonroad::Scenario scenario = commonroad::parse_scenario(bytes, name);
  const auto count = [&](commonroad::ObstacleRole role) {
    return std::count_if(scenario.obstacles.begin(), scenario.obstacles.end(),
                         [&](const commonroad::Obstacle& o) { return o.role == role; });
  };
  long last_step = 0;
  for (const commonroad::Obstacle& obstacle : scenario.obstacles) {
    for (const commonroad::State& state : obstacle.trajectory) {
      last_step = std::max(last_step, state.time_step.most);
    }
  }
  return {{"benchmark_id", scenario.benchmark_id},
          {"time_step_s", scenario.time_step_s},
          {"static_obstacles", count(commonroad::ObstacleRole::fixed)},
          {"dynamic_obstacles", count(commonroad::ObstacleRole::dynamic)},
          {"other_obstacles",
           count(commonroad::ObstacleRole::environment) + count(commonroad::ObstacleRole::phantom)},
          {"recorded_s", static_cast<double>(last_step) * scenario.time_step_s},
          {"planning_problems", scenario.planning_problems.size()}};
}

class InfoCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Say what a map holds: counts, lengths, areas, bounds, connectivity");
    arguments.add("MAP", input_, "Any readable map").required().ending(kMapEndings);
    arguments.flag("--verify", verify_, "Check every byte and record of a compiled map");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.example("  roadbed info town.xodr --json");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    const map::RoadMap road_map = map::load_map(input_);
    Json info = info_json(road_map);
    const map::Format* format = map::format_of(road_map);
    if (format != nullptr && format->name == "CommonRoad") {
      info["scenario"] = scenario_counts(map::read_file(input_), map::input_name(input_));
    }
    if (verify_) info["verified"] = verified_json(verified());
    if (json_) {
      streams.out << map::json_text(versioned("info", info), 2) << '\n';
    } else {
      print_info(streams.out, info);
    }
    return Exit::ok;
  }

 private:
  map::VerifiedMap verified() const {
    const bool is_plain = map::is_compiled_map(map::stored_start(input_, 16));
    return is_plain ? map::verify_compiled_map(input_)
                    : map::verify_compiled_map(map::read_file(input_), map::input_name(input_));
  }

  std::filesystem::path input_;
  bool verify_ = false, json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_info_command() { return std::make_unique<InfoCommand>(); }

}  // namespace roadbed::tools::commands::maps
