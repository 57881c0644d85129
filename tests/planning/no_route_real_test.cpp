// Explanations on a real map on which most pairs of lanes are not connected.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using map::LaneId;

// Whether links and neighbours of any kind lead from one lane to another, by flooding the map.
bool connected(const map::RoadMap& road_map, LaneId from, LaneId to, bool both_ways, bool all_lanes,
               bool all_markings) {
  std::vector<bool> seen(road_map.lanes().size(), false);
  std::vector<LaneId> open{from};
  seen[from.index] = true;
  const auto visit = [&](LaneId lane) {
    if (seen[lane.index]) return;
    if (!all_lanes && !may_use(road_map.lane(lane), map::Participant::car)) return;
    seen[lane.index] = true;
    open.push_back(lane);
  };
  while (!open.empty()) {
    const map::LaneLinks& links = road_map.graph().of(open.back());
    open.pop_back();
    for (const LaneId next : links.successors) visit(next);
    for (const auto& beside : {links.left, links.right}) {
      if (!beside) continue;
      if (beside->same_direction && (all_markings || beside->change_allowed())) visit(beside->lane);
      if (!beside->same_direction && both_ways) visit(beside->lane);
    }
    if (!both_ways) continue;
    for (const LaneId before : links.predecessors) visit(before);
  }
  return seen[to.index];
}

TEST(RouteObstacle, OnARealMapHoldsAgainstFloodingIt) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const map::RoadMap road_map = map::load_map(
      folder / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm");
  Router router(road_map);
  std::mt19937 random(20261121);
  std::map<Barrier, int> seen;
  int none = 0;
  while (none < 100) {
    const auto any_lane = [&] {
      return LaneId{static_cast<std::uint32_t>(random() % road_map.lanes().size())};
    };
    const LaneId from = any_lane(), to = any_lane();
    const RouteAnswer answer =
        router.find({from, 0.0, 0.0}, {to, 0.5 * road_map.lane(to).length_m(), 0.0});
    if (answer.route || !answer.obstacle) continue;
    ++none;
    SCOPED_TRACE(answer.reason);
    const RouteObstacle& obstacle = *answer.obstacle;
    ASSERT_FALSE(obstacle.barriers.empty());
    EXPECT_GE(obstacle.lanes_from_start, 1U);
    EXPECT_GE(obstacle.lanes_to_goal, 1U);
    EXPECT_TRUE(std::isfinite(obstacle.gap_m));
    const auto holds = [&](Barrier barrier) {
      return std::count(obstacle.barriers.begin(), obstacle.barriers.end(), barrier) > 0;
    };
    for (const Barrier barrier : obstacle.barriers) ++seen[barrier];
    EXPECT_FALSE(holds(Barrier::closed)) << "nothing is closed";
    EXPECT_EQ(connected(road_map, from, to, true, true, true), !holds(Barrier::map_gap));
    if (holds(Barrier::map_gap)) {
      EXPECT_EQ(obstacle.barriers.size(), 1U);
      continue;
    }
    // Lanes too short for a change can be reached all the same: no step out of them is missing.
    EXPECT_TRUE(holds(Barrier::length) || (obstacle.blocked_from && obstacle.blocked_to));
    // With the named rules left out the map is connected. Rules are put back in this order, each
    // while those after it are still left out: so without it alone the map is not.
    const bool one_way = holds(Barrier::one_way), users = holds(Barrier::participant),
               marking = holds(Barrier::marking);
    EXPECT_TRUE(connected(road_map, from, to, one_way, users, marking));
    if (one_way) {
      EXPECT_FALSE(connected(road_map, from, to, false, true, true));
    }
    if (users) {
      EXPECT_FALSE(connected(road_map, from, to, one_way, false, true));
    }
    if (marking) {
      EXPECT_FALSE(connected(road_map, from, to, one_way, users, false));
    }
  }
  EXPECT_GE(seen.size(), 3U);
}

}  // namespace
}  // namespace roadbed::planning
