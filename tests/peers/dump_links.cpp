// Usage: dump_links MAP: what the lanes of a map lead to, a JSON object per line, for scripts that
// compare it with other programs' answers.
#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <iostream>
#include <string>

#include "roadbed/map/load_map.h"

namespace {

using namespace roadbed::map;

std::string names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::string list;
  for (const LaneId id : lanes) {
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ",", road_map.lane(id).name);
  }
  return "[" + list + "]";
}

std::string side(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  if (!neighbour) return "null";
  return fmt::format(R"({{"lane":"{}","same":{},"change":{}}})",
                     road_map.lane(neighbour->lane).name, neighbour->same_direction,
                     neighbour->change_allowed());
}

void print(const RoadMap& road_map, const Lane& lane) {
  const LaneLinks& links = road_map.graph().of(lane.id);
  const auto limit_mps = lane.speed_limit_at_mps(0.0);
  std::cout
      << fmt::format(
             R"({{"lane":"{}","car":{},"foot":{},"one_way":{},"length_m":{},"limit_mps":{},"successors":{},)"
             R"("left":{},"right":{}}})",
             lane.name, is_drivable(lane.type) && lane.participants.has(Participant::car),
             lane.participants.has(Participant::pedestrian), lane.one_way, lane.length_m(),
             limit_mps && std::isfinite(*limit_mps) ? fmt::format("{}", *limit_mps) : "null",
             names(road_map, links.successors), side(road_map, links.left),
             side(road_map, links.right))
      << '\n';
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 2) return 2;
  const RoadMap road_map = load_map(arguments[1]);
  for (const Lane& lane : road_map.lanes()) print(road_map, lane);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
