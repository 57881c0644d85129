#include "roadbed/map/sumo/inner_lanes.h"
#include "roadbed/geometry/primitives/disjoint_sets.h"

#include <algorithm>

#include "roadbed/map/derived/crossings.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kLeastTurn_m = 2.0;     // of what leads nowhere, as its end is an edge
constexpr double kLongestTurn_m = 60.0;  // across a crossing that the map does not name

using Numbers = std::vector<std::optional<std::uint32_t>>;

// Whether two short lanes cross each other; those of a road are where the map says.
bool cross(const RoadMap& road_map, const Conflict& conflict) {
  if (conflict.kind != ConflictKind::crossing) return false;
  const Lane &one = road_map.lane(conflict.one), &other = road_map.lane(conflict.other);
  return !one.road && !other.road && one.length_m() < kLongestTurn_m &&
         other.length_m() < kLongestTurn_m;
}

// Lanes without a number that cross one which has one, or each other where none has.
void add_crossing(const RoadMap& road_map, const std::vector<Conflict>& conflicts,
                  Numbers& numbers) {
  const Numbers named = numbers;
  const bool names_any = std::any_of(named.begin(), named.end(),
                                     [](const auto& number) { return number.has_value(); });
  geometry::DisjointSets sets(numbers.size());
  std::vector<bool> is_inner(numbers.size());
  for (const Conflict& conflict : conflicts) {
    if (!cross(road_map, conflict)) continue;
    const std::uint32_t one = conflict.one.index, other = conflict.other.index;
    if (names_any) {
      if (named[one] && !named[other]) numbers[other] = named[one];
      if (named[other] && !named[one]) numbers[one] = named[other];
    } else {
      is_inner[one] = is_inner[other] = true;
      sets.join(one, other);
    }
  }
  auto next = static_cast<std::uint32_t>(road_map.junctions().size());
  Numbers of_set(numbers.size());
  for (std::uint32_t lane = 0; lane < numbers.size(); ++lane) {
    if (!is_inner[lane]) continue;
    auto& number = of_set[sets.of(lane)];
    if (!number) number = next++;
    numbers[lane] = number;
  }
}

}  // namespace

Numbers find_inner_lanes(const RoadMap& road_map, const DirectedLanes& ways,
                         const std::vector<Conflict>& conflicts) {
  std::vector<bool> counts(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) counts[lane.id.index] = ways.has({lane.id, false});
  Numbers numbers = crossings_of_lanes(road_map, counts);
  add_crossing(road_map, conflicts, numbers);
  for (const Lane& lane : road_map.lanes()) {
    const auto is_apart = [&](DirectedLane way) {
      const bool ends = ways.next(way).empty(), begins = ways.before(way).empty();
      return ways.has(way) && (ends || begins) &&
             ((ends && begins) || lane.length_m() < kLeastTurn_m);
    };
    if (is_apart({lane.id, false}) || is_apart({lane.id, true})) numbers[lane.id.index].reset();
  }
  return numbers;
}

}  // namespace roadbed::map::sumo
