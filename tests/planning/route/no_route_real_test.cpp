// Explanations on a real map on which most pairs of lanes are not connected.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/two_way_oracle.h"

namespace roadbed::planning {
namespace {

using map::LaneId;

// Whether links and neighbours of any kind lead from one lane to another, by flooding the map: each
// lane in its direction, and against it where that is allowed, or everywhere if `both_ways`.
class Flood {
 public:
  Flood(const map::RoadMap& road_map, bool both_ways, bool all_lanes, bool all_markings)
      : road_map_(road_map),
        both_ways_(both_ways),
        all_lanes_(all_lanes),
        all_markings_(all_markings),
        seen_(2 * road_map.lanes().size(), false) {}

  bool connects(LaneId from, LaneId to) {
    visit(from, false);
    visit(from, true);
    while (!open_.empty()) {
      const auto [lane, against] = open_.back();
      open_.pop_back();
      leave(lane, against);
    }
    return seen_[2 * to.index] || seen_[2 * to.index + 1];
  }

 private:
  void visit(LaneId lane, bool against) {
    const map::Lane& entered = road_map_.lane(lane);
    if (seen_[2 * lane.index + (against ? 1 : 0)]) return;
    if (!all_lanes_ && !may_use(entered, map::Participant::car)) return;
    if (against && !both_ways_ && entered.one_way) return;
    seen_[2 * lane.index + (against ? 1 : 0)] = true;
    open_.push_back({lane, against});
  }

  void leave(LaneId lane, bool against) {
    for (const map::Lane& next : road_map_.lanes()) {
      for (const bool next_against : {false, true}) {
        if (tests::leads_to(road_map_, lane, against, next.id, next_against)) {
          visit(next.id, next_against);
        }
      }
    }
    const map::LaneLinks& links = road_map_.graph().of(lane);
    for (const auto& beside : {links.left, links.right}) {
      if (!beside) continue;
      if (all_markings_ || beside->change_allowed()) {
        visit(beside->lane, beside->same_direction == against);
      }
      if (both_ways_ && !beside->same_direction) visit(beside->lane, against);
    }
    if (!both_ways_) return;
    visit(lane, !against);
  }

  const map::RoadMap& road_map_;
  bool both_ways_, all_lanes_, all_markings_;
  std::vector<bool> seen_;
  std::vector<std::pair<LaneId, bool>> open_;
};

bool connected(const map::RoadMap& road_map, LaneId from, LaneId to, bool both_ways, bool all_lanes,
               bool all_markings) {
  return Flood(road_map, both_ways, all_lanes, all_markings).connects(from, to);
}

TEST(NoRouteExplanation, OnARealMapHoldsAgainstFloodingIt) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const map::RoadMap road_map = map::load_map(
      folder / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm");
  Router router(road_map);
  std::mt19937 random(20261121);
  std::map<BlockingRule, int> seen;
  int none = 0;
  while (none < 100) {
    const auto any_lane = [&] {
      return LaneId{static_cast<std::uint32_t>(random() % road_map.lanes().size())};
    };
    const LaneId from = any_lane(), to = any_lane();
    const RouteAnswer answer =
        router.find({from, 0.0, 0.0}, {to, 0.5 * road_map.lane(to).length_m(), 0.0});
    if (answer.route || !answer.explanation) continue;
    ++none;
    SCOPED_TRACE(answer.reason);
    const NoRouteExplanation& explanation = *answer.explanation;
    ASSERT_FALSE(explanation.blocking_rules.empty());
    EXPECT_GE(explanation.lanes_from_start, 1U);
    EXPECT_GE(explanation.lanes_to_goal, 1U);
    EXPECT_TRUE(std::isfinite(explanation.gap_m));
    const auto holds = [&](BlockingRule barrier) {
      return std::count(explanation.blocking_rules.begin(), explanation.blocking_rules.end(),
                        barrier) > 0;
    };
    for (const BlockingRule barrier : explanation.blocking_rules) ++seen[barrier];
    EXPECT_FALSE(holds(BlockingRule::closed)) << "nothing is closed";
    EXPECT_EQ(connected(road_map, from, to, true, true, true), !holds(BlockingRule::map_gap));
    if (holds(BlockingRule::map_gap)) {
      EXPECT_EQ(explanation.blocking_rules.size(), 1U);
      continue;
    }
    // Lanes too short for a change can be reached all the same: no step out of them is missing.
    EXPECT_TRUE(holds(BlockingRule::length) ||
                (explanation.blocked_from && explanation.blocked_to));
    // With the named rules left out the map is connected. Rules are put back in this order, each
    // while those after it are still left out: so without it alone the map is not.
    const bool one_way = holds(BlockingRule::one_way), users = holds(BlockingRule::participant),
               marking = holds(BlockingRule::marking);
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
