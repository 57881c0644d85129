// Prints what roadbed reads of a CommonRoad file as one JSON document, for compare_common_road.py.
#include <iostream>
#include <nlohmann/json.hpp>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"

namespace {

using Json = nlohmann::json;
using namespace roadbed;
namespace cr = map::commonroad;

Json points(const map::RoadMap& road_map, const map::LaneLine& line) {
  Json json = Json::array();
  for (std::size_t i = 0; i < line.z_m.size(); ++i) {
    const Eigen::Vector2d at = road_map.to_source(line.in_map.points()[i]);
    json.push_back({at.x(), at.y(), line.z_m[i]});
  }
  return json;
}

Json names(const map::RoadMap& road_map, const std::vector<map::LaneId>& lanes) {
  Json json = Json::array();
  for (const map::LaneId id : lanes) json.push_back(road_map.lane(id).name);
  return json;
}

Json beside(const map::RoadMap& road_map, const std::optional<map::Neighbour>& neighbour) {
  if (!neighbour) return nullptr;
  return {road_map.lane(neighbour->lane).name, neighbour->same_direction};
}

Json lane_json(const map::RoadMap& road_map, const map::Lane& lane) {
  const map::LaneLinks& links = road_map.graph().of(lane.id);
  const auto limit = lane.least_speed_limit_mps();
  return {{"left", points(road_map, lane.left)},
          {"right", points(road_map, lane.right)},
          {"centre", points(road_map, lane.centre)},
          {"successors", names(road_map, links.successors)},
          {"predecessors", names(road_map, links.predecessors)},
          {"adjacent_left", beside(road_map, links.left)},
          {"adjacent_right", beside(road_map, links.right)},
          {"speed_limit_mps", limit ? Json(*limit) : Json()}};
}

Json signal_json(const map::RoadMap& road_map, const map::Signal& signal) {
  const Eigen::Vector2d at = road_map.to_source(signal.in_map);
  return {{"id", signal.source_id},         {"type", signal.type},
          {"at", {at.x(), at.y()}},         {"text", signal.text},
          {"dynamic", signal.dynamic},      {"lanes", names(road_map, signal.lanes)},
          {"attributes", signal.attributes}};
}

Json stop_line_json(const map::RoadMap& road_map, const map::StopLine& line) {
  Json ends = Json::array();
  for (const Eigen::Vector3d& point : line.in_map) {
    const Eigen::Vector2d at = road_map.to_source(point.head<2>());
    ends.push_back({at.x(), at.y()});
  }
  return {{"ends", ends}, {"signals", line.signals}, {"lanes", names(road_map, line.lanes)}};
}

Json rule_json(const map::Regulation& rule) {
  Json members = Json::array();
  for (const map::RegulationMember& member : rule.members) {
    members.push_back({member.role, member.source_id,
                       member.attributes.empty() ? "" : member.attributes.front().second});
  }
  return {{"id", rule.source_id}, {"type", rule.type}, {"members", members}};
}

Json range_json(const std::optional<cr::Range<double>>& range) {
  if (!range) return nullptr;
  return {range->least, range->most};
}

Json xy(const Eigen::Vector2d& point) { return {point.x(), point.y()}; }

Json shape_json(const cr::Shape& shape) {
  Json parts = Json::array();
  for (const auto& part : shape) {
    if (const auto* box = std::get_if<cr::RectangleShape>(&part)) {
      parts.push_back({{"length", box->length_m},
                       {"width", box->width_m},
                       {"heading", box->heading_rad},
                       {"centre", xy(box->centre_m)}});
    } else if (const auto* circle = std::get_if<cr::CircleShape>(&part)) {
      parts.push_back({{"radius", circle->radius_m}, {"centre", xy(circle->centre_m)}});
    } else {
      Json corners = Json::array();
      for (const auto& corner : std::get<cr::PolygonShape>(part).corners_m) {
        corners.push_back(xy(corner));
      }
      parts.push_back({{"corners", corners}});
    }
  }
  return parts;
}

Json state_json(const cr::State& state) {
  Json others = Json::object();
  for (const auto& [name, range] : state.others) others[name] = range_json(range);
  return {{"time", {state.time_step.least, state.time_step.most}},
          {"position", state.position_m ? xy(*state.position_m) : Json()},
          {"region", shape_json(state.region)},
          {"lanelets", state.lanelets},
          {"orientation", range_json(state.heading_rad)},
          {"velocity", range_json(state.speed_mps)},
          {"acceleration", range_json(state.acceleration_mps2)},
          {"others", others}};
}

Json states_json(const std::vector<cr::State>& states) {
  Json json = Json::array();
  for (const cr::State& state : states) json.push_back(state_json(state));
  return json;
}

Json obstacle_json(const cr::Obstacle& obstacle) {
  Json occupancies = Json::array();
  for (const cr::Occupancy& part : obstacle.occupancy_set) {
    occupancies.push_back({{"time", {part.time_step.least, part.time_step.most}},
                           {"region", shape_json(part.region)}});
  }
  return {{"type", obstacle.type},
          {"role", static_cast<int>(obstacle.role)},
          {"shape", shape_json(obstacle.shape)},
          {"initial", obstacle.initial_state ? state_json(*obstacle.initial_state) : Json()},
          {"trajectory", states_json(obstacle.trajectory)},
          {"occupancies", occupancies}};
}

Json dump(const std::string& file) {
  const map::RoadMap road_map = map::load_map(file);
  Json json;
  for (const map::Lane& lane : road_map.lanes()) {
    json["lanelets"][lane.name] = lane_json(road_map, lane);
  }
  json["signals"] = json["stop_lines"] = json["intersections"] = Json::array();
  for (const auto& signal : road_map.signals()) {
    json["signals"].push_back(signal_json(road_map, signal));
  }
  for (const auto& line : road_map.stop_lines()) {
    json["stop_lines"].push_back(stop_line_json(road_map, line));
  }
  for (const auto& rule : road_map.regulations()) {
    json["intersections"].push_back(rule_json(rule));
  }
  const cr::Scenario scenario = cr::parse_scenario(map::read_file(file), file);
  json["dt"] = scenario.time_step_s;
  json["benchmark_id"] = scenario.benchmark_id;
  json["obstacles"] = json["problems"] = Json::object();
  for (const auto& obstacle : scenario.obstacles) {
    json["obstacles"][obstacle.id] = obstacle_json(obstacle);
  }
  for (const auto& problem : scenario.planning_problems) {
    json["problems"][problem.id] = {{"initial", state_json(problem.initial_state)},
                                    {"goals", states_json(problem.goals)}};
  }
  return json;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: dump_common_road FILE\n";
    return 2;
  }
  try {
    std::cout << dump(arguments[1]) << '\n';
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
