#include "roadbed/tools/audit/route_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline audit {
namespace {

RouteFileLeg leg_of(const JsonNode& node, const map::RoadMap& road_map) {
  const JsonNode lane = node.at("lane");
  const auto id = road_map.find_lane(lane.text());
  if (!id) {
    lane.refuse(fmt::format("lane {} is not in the map", lane.name()), "a lane of --map",
                "find the route on the same map");
  }
  constexpr double rounding_m = 0.01;
  const double length_m = road_map.lane(*id).length_m();
  const Range along{-rounding_m, length_m + rounding_m};
  return {*id, node.number_or("from_s_m", 0.0, along), node.number_or("to_s_m", length_m, along)};
}

}  // namespace

std::vector<RouteFileLeg> read_route_file(const std::filesystem::path& file,
                                          const map::RoadMap& road_map) {
  const std::string name = map::input_name(file);
  const nlohmann::json document = parse_json_strictly(map::read_file(file), name);
  const JsonNode route(document, name);
  if (!route.at("found").boolean()) {
    route.at("found").refuse("no route was found", "a route, as route --json prints it",
                             "choose another start or goal");
  }
  std::vector<RouteFileLeg> legs;
  for (const JsonNode& node : route.at("lanes").elements()) {
    legs.push_back(leg_of(node, road_map));
  }
  if (legs.empty()) route.at("lanes").refuse("is empty", "a lane at least", "find a route");
  return legs;
}

}  // namespace roadbed::tools::audit
