#include "roadbed/map/derived/crossings.h"

#include <algorithm>
#include <map>

namespace roadbed::map::inline derived {
namespace {

using Crossings = std::vector<std::optional<std::uint32_t>>;

// Lanes that turn, as Lanelet2 says it, and lie over each other are in one crossing.
void name_turns(const RoadMap& road_map, const std::vector<bool>& counts, std::uint32_t next,
                Crossings& crossings) {
  std::map<LaneId, LaneId> leader;
  for (const Lane& lane : road_map.lanes()) {
    const bool turns = std::any_of(lane.attributes.begin(), lane.attributes.end(),
                                   [](const auto& tag) { return tag.first == "turn_direction"; });
    if (turns && counts[lane.id.index]) leader.emplace(lane.id, lane.id);
  }
  const auto find = [&](LaneId lane) {
    while (leader.at(lane) != lane) lane = leader.at(lane) = leader.at(leader.at(lane));
    return lane;
  };
  constexpr double step_m = 2.0, inside_m = 0.01;
  for (const auto& [id, first] : leader) {
    const Lane& lane = road_map.lane(id);
    for (double s_m = 0.5 * step_m; s_m < lane.length_m(); s_m += step_m) {
      for (const LaneMatch& match : road_map.locate(lane.centre.in_map.at(s_m), inside_m, false)) {
        if (!leader.contains(match.place.lane)) continue;
        const LaneId a = find(id), b = find(match.place.lane);
        leader.at(std::max(a, b)) = std::min(a, b);
      }
    }
  }
  std::map<LaneId, std::uint32_t> numbers;
  for (const auto& [id, first] : leader) {
    const auto [found, is_new] = numbers.emplace(find(id), next);
    next += is_new ? 1 : 0;
    crossings[id.index] = found->second;
  }
}

}  // namespace

Crossings crossings_of_lanes(const RoadMap& road_map, const std::vector<bool>& counts) {
  Crossings crossings(road_map.lanes().size());
  auto next = static_cast<std::uint32_t>(road_map.junctions().size());
  for (const Regulation& regulation : road_map.regulations()) {
    if (regulation.type != "intersection") continue;
    for (const RegulationMember& member : regulation.members) {
      if (member.lane && member.role.starts_with("successors")) {
        crossings[member.lane->index] = next;
      }
    }
    ++next;
  }
  name_turns(road_map, counts, next, crossings);
  for (const Lane& lane : road_map.lanes()) {
    if (lane.junction) crossings[lane.id.index] = lane.junction->index;
  }
  return crossings;
}

bool is_crosswalk(const Lane& lane) {
  return std::any_of(lane.attributes.begin(), lane.attributes.end(),
                     [](const auto& tag) { return tag.second == "crosswalk"; });
}

}  // namespace roadbed::map::derived
