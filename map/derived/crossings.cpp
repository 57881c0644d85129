#include "roadbed/map/derived/crossings.h"

#include <algorithm>
#include <map>

#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/derived/crowded.h"

namespace roadbed::map::inline derived {
namespace {

using Crossings = std::vector<std::optional<std::uint32_t>>;

// Whether a lane turns, as Lanelet2 says it.
bool turns(const Lane& lane) {
  return std::any_of(lane.attributes.begin(), lane.attributes.end(),
                     [](const auto& tag) { return tag.first == "turn_direction"; });
}

// Lanes that turn and lie over each other are in one crossing.
void name_turns(const RoadMap& road_map, const std::vector<bool>& counts, std::uint32_t next,
                Crossings& crossings) {
  std::vector<bool> is_turn(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) {
    is_turn[lane.id.index] = counts[lane.id.index] && turns(lane);
  }
  geometry::DisjointSets sets(road_map.lanes().size());
  geometry::WorkBudget matches(geometry::most_steps(road_map.lanes().size()));
  constexpr double step_m = 2.0, inside_m = 0.01;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_turn[lane.id.index]) continue;
    for (double s_m = 0.5 * step_m; s_m < lane.length_m(); s_m += step_m) {
      const auto found = road_map.locate(lane.centre.in_map.at(s_m), inside_m, false);
      if (!matches.spend(found.size())) {
        refuse_crowded("crossings", "so many lanes that turn lie over each other");
      }
      for (const LaneMatch& match : found) {
        const std::uint32_t other = match.place.lane.index;
        if (is_turn[other]) sets.join(lane.id.index, other);
      }
    }
  }
  std::map<std::size_t, std::uint32_t> numbers;
  for (std::uint32_t lane = 0; lane < is_turn.size(); ++lane) {
    if (!is_turn[lane]) continue;
    const auto [found, is_new] = numbers.emplace(sets.of(lane), next);
    next += is_new ? 1 : 0;
    crossings[lane] = found->second;
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
