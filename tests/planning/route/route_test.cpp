#include "roadbed/planning/route/router.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/route_oracle.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using map::LanePlace;
using map::RoadMap;

using tests::RouteOracle;

// Crossings in a grid, with roads of one to four lanes between neighbours, random limits, types,
// markings and links; link ends do not meet, so straight lines are shorter than lanes are long.
RoadMap random_grid(std::mt19937& random, int columns, int rows) {
  tests::MadeMap made;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<std::vector<LaneId>> in(static_cast<std::size_t>(columns * rows)), out(in.size());
  const auto crossing = [&](int x, int y) { return static_cast<std::size_t>(y * columns + x); };
  const auto add_road = [&](int x0, int y0, int x1, int y1) {
    const Eigen::Vector2d from(120.0 * x0, 60.0 * y0), to(120.0 * x1, 60.0 * y1);
    const Eigen::Vector2d along = (to - from).normalized(), right(along.y(), -along.x());
    const auto road = made.add_road(std::to_string(made.parts.roads.size()));
    const int lanes = 1 + static_cast<int>(4.0 * unit(random));
    const double cut_m = 5.0 + 20.0 * unit(random);
    std::vector<LaneId> added;
    for (int i = 0; i < lanes; ++i) {
      const Eigen::Vector2d left = from + cut_m * along + 3.5 * i * right;
      const double length_m = (to - from).norm() - 2.0 * cut_m;
      added.push_back(
          made.add_lane(road, std::to_string(-1 - i), {left, left + length_m * along},
                        {left + 3.5 * right, left + 3.5 * right + length_m * along},
                        unit(random) < 0.95 ? map::LaneType::driving : map::LaneType::shoulder));
      made.lane(added.back()).speed_limits = {
          {0.0, unit(random) < 0.9 ? std::optional(5.0 + 30.0 * unit(random)) : std::nullopt}};
      if (i > 0) made.put_beside(added[added.size() - 2], added.back(), unit(random) < 0.6);
      out[crossing(x0, y0)].push_back(added.back());
      in[crossing(x1, y1)].push_back(added.back());
    }
  };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (x + 1 < columns) {
        add_road(x, y, x + 1, y);
        add_road(x + 1, y, x, y);
      }
      if (y + 1 < rows) {
        add_road(x, y, x, y + 1);
        add_road(x, y + 1, x, y);
      }
    }
  }
  for (std::size_t i = 0; i < in.size(); ++i) {
    for (const LaneId from : in[i]) {
      for (const LaneId to : out[i]) {
        if (unit(random) < 0.3) made.link(from, to);
      }
    }
  }
  return made.build();
}

LanePlace random_place(std::mt19937& random, const RoadMap& road_map) {
  std::uniform_int_distribution<std::size_t> lane(0, road_map.lanes().size() - 1);
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  for (;;) {
    const map::Lane& chosen = road_map.lanes()[lane(random)];
    if (is_drivable(chosen.type)) return {chosen.id, fraction(random) * chosen.length_m(), 0.0};
  }
}

// Every leg continues the one before: by a link, or beside it at the same share of the way.
void expect_connected(const RoadMap& road_map, const Route& route, const LanePlace& from,
                      const LanePlace& to, const RouteOptions& options) {
  ASSERT_FALSE(route.legs.empty());
  EXPECT_EQ(route.legs.front().lane, from.lane);
  EXPECT_EQ(route.legs.back().lane, to.lane);
  EXPECT_NEAR(route.legs.front().from_s_m, from.s_m, 1e-9);
  EXPECT_NEAR(route.legs.back().to_s_m, to.s_m, 1e-9);
  EXPECT_EQ(route.legs.back().exit, LegExit::goal);
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    const RouteLeg& leg = route.legs[i];
    const map::Lane& lane = road_map.lane(leg.lane);
    EXPECT_LE(leg.from_s_m, leg.to_s_m + 1e-9);
    EXPECT_TRUE(is_drivable(lane.type));
    if (i > 0) {
      EXPECT_EQ(std::count(options.avoid.begin(), options.avoid.end(), leg.lane), 0);
    }
    if (i + 1 == route.legs.size()) break;
    const RouteLeg& next = route.legs[i + 1];
    const map::LaneLinks& links = road_map.graph().of(leg.lane);
    if (leg.exit == LegExit::successor) {
      EXPECT_EQ(std::count(links.successors.begin(), links.successors.end(), next.lane), 1);
      EXPECT_NEAR(leg.to_s_m, lane.length_m(), 1e-9);
      EXPECT_EQ(next.from_s_m, 0.0);
    } else {
      const auto& beside = leg.exit == LegExit::change_left ? links.left : links.right;
      ASSERT_TRUE(beside && beside->change_allowed() && beside->same_direction);
      EXPECT_EQ(beside->lane, next.lane);
      EXPECT_NEAR(leg.to_s_m / lane.length_m(), next.from_s_m / road_map.lane(next.lane).length_m(),
                  1e-9);
    }
  }
}

struct RouteTally {
  int found = 0, none = 0, with_changes = 0;
};

void compare_with_boost(const RoadMap& road_map, std::mt19937& random, int pairs,
                        const RouteOptions& options, RouteTally& tally) {
  const RouteOracle oracle(road_map, options);
  Router router(road_map, options);
  for (int i = 0; i < pairs; ++i) {
    const LanePlace from = random_place(random, road_map), to = random_place(random, road_map);
    if (!router.unfit(from, "start").empty() || !router.unfit(to, "goal").empty()) continue;
    const RouteAnswer answer = router.find(from, to);
    const double expected = oracle.cost(from, to);
    ASSERT_EQ(answer.route.has_value(), std::isfinite(expected))
        << road_map.lane(from.lane).name << " to " << road_map.lane(to.lane).name;
    if (!answer.route) {
      ++tally.none;
      EXPECT_FALSE(answer.reason.empty());
      continue;
    }
    ++tally.found;
    tally.with_changes += answer.route->lane_changes > 0 ? 1 : 0;
    const double cost =
        options.cost == RouteCost::time ? answer.route->cost_s : answer.route->cost_m;
    // Each arc is rounded to 0.1 ms or 1 mm before ways are compared.
    ASSERT_NEAR(cost, expected, 1e-3 * static_cast<double>(answer.route->legs.size() + 1));
    ASSERT_GE(cost, expected - 1e-9 * (1.0 + expected));
    expect_connected(road_map, *answer.route, from, to, options);
  }
}

TEST(FindRoute, CostsWhatDijkstraOfAnotherLibraryFindsOnRandomGrids) {
  std::mt19937 random(20261121);
  RouteTally tally;
  for (int trial = 0; trial < 12; ++trial) {
    const RoadMap road_map = random_grid(random, 3 + trial % 3, 2 + trial % 2);
    RouteOptions options;
    options.cost = trial % 2 == 0 ? RouteCost::time : RouteCost::distance;
    if (trial % 3 == 1) options.prices_s.lane_change = options.prices_m.lane_change = 0.0;
    if (trial % 3 == 2) options.least_lane_change_m = 45.0;
    for (int i = 0; i < trial % 4; ++i)
      options.avoid.push_back(random_place(random, road_map).lane);
    compare_with_boost(road_map, random, 60, options, tally);
  }
  EXPECT_GT(tally.found, 300);
  EXPECT_GT(tally.none, 30);
  EXPECT_GT(tally.with_changes, 100);
}

TEST(FindRoute, CostsWhatDijkstraOfAnotherLibraryFindsOnRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  RouteTally tally;
  for (const char* file :
       {"BerkeleyLearnVerify+Scenic/Town10HD.xodr", "esmini+esmini/multi_intersections.xodr",
        "esmini+esmini/highway_example_with_merge_and_split.xodr"}) {
    const RoadMap road_map = map::load_map(folder / "opendrive" / file);
    // Marking windows and bends are left to tests of their own.
    RouteOptions options;
    options.lateral_acceleration_mps2 = 1e9;
    options.prices_s.u_turn = 0.0;
    compare_with_boost(road_map, random, 40, options, tally);
  }
  EXPECT_GT(tally.found, 60);
}

using tests::TwoLanes;

TEST(FindRoute, ChangesLaneInTheMiddleOfThePassageAndCountsItsLengthOnce) {
  const TwoLanes lanes;
  const RoadMap road_map = lanes.made.build();
  const RouteAnswer answer =
      find_route(road_map, {lanes.left, 20.0, 0.0}, {lanes.after_right, 50.0, 0.0});
  ASSERT_TRUE(answer.route);
  ASSERT_EQ(answer.route->legs.size(), 3U);
  EXPECT_EQ(answer.route->legs[0].exit, LegExit::change_right);
  EXPECT_NEAR(answer.route->legs[0].to_s_m, 60.0, 1e-9);
  EXPECT_NEAR(answer.route->legs[1].from_s_m, 60.0, 1e-9);
  EXPECT_EQ(answer.route->legs[1].exit, LegExit::successor);
  EXPECT_NEAR(answer.route->length_m, 130.0, 1e-9);
  EXPECT_NEAR(answer.route->cost_s, 130.0 / 13.9 + 5.0, 1e-9);
  EXPECT_EQ(answer.route->lane_changes, 1);
}

struct MetrePlace {
  LaneId lane;
  int metre;
  int side;  // to which lanes are changed in this lane group: 1 left, -1 right, 0 none so far

  auto operator<=>(const MetrePlace&) const = default;
};

// Whether metre by metre a way leads to the goal: on along a lane, over a link at its end, or in
// 11 m to the lane beside, to one side in each lane group, none of it through what is blocked.
bool is_reached_by_metres(const RoadMap& road_map, const LanePlace& from, const LanePlace& to,
                          const RouteOptions& options) {
  const auto is_free = [&](LaneId lane, double from_s_m, double to_s_m) {
    return std::ranges::none_of(options.blocked, [&](const BlockedStretch& stretch) {
      return stretch.lane == lane && stretch.stations.from_s_m < to_s_m &&
             stretch.stations.to_s_m > from_s_m;
    });
  };
  std::set<MetrePlace> seen;
  std::vector<MetrePlace> open;
  const auto reach = [&](const MetrePlace& place) {
    if (!is_drivable(road_map.lane(place.lane).type)) return;
    if (seen.insert(place).second) open.push_back(place);
  };
  const auto change = [&](const MetrePlace& at, const std::optional<map::Neighbour>& to_lane,
                          int side) {
    const int end = at.metre + 11;
    if (at.side == -side || !to_lane || !to_lane->change_allowed()) return;
    if (end > road_map.lane(at.lane).length_m() || !is_free(at.lane, at.metre, end)) return;
    if (is_free(to_lane->lane, at.metre, end)) reach({to_lane->lane, end, side});
  };
  reach({from.lane, static_cast<int>(std::ceil(from.s_m)), 0});
  while (!open.empty()) {
    const MetrePlace at = open.back();
    open.pop_back();
    const double length_m = road_map.lane(at.lane).length_m(), next_m = at.metre + 1.0;
    const map::LaneLinks& links = road_map.graph().of(at.lane);
    const bool is_on_goal_lane = at.lane == to.lane && at.metre <= to.s_m;
    if (is_on_goal_lane && is_free(at.lane, at.metre, to.s_m)) return true;
    if (next_m <= length_m && is_free(at.lane, at.metre, next_m)) {
      reach({at.lane, at.metre + 1, at.side});
    }
    if (next_m > length_m && is_free(at.lane, at.metre, length_m)) {
      for (const LaneId next : links.successors) reach({next, 0, 0});
    }
    change(at, links.left, 1);
    change(at, links.right, -1);
  }
  return false;
}

void expect_past(const RoadMap& road_map, const std::vector<BlockedStretch>& blocked,
                 const Route& route) {
  for (const RouteLeg& leg : route.legs) {
    for (const BlockedStretch& stretch : blocked) {
      if (stretch.lane != leg.lane) continue;
      EXPECT_TRUE(leg.to_s_m <= stretch.stations.from_s_m + 1e-9 ||
                  leg.from_s_m >= stretch.stations.to_s_m - 1e-9)
          << road_map.lane(leg.lane).name;
    }
  }
}

TEST(FindRoute, LeadsPastWhatIsBlockedWhereverTryingMetreByMetreDoes) {
  std::mt19937 random(20261123);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  RouteTally tally;
  int detours = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const RoadMap road_map = random_grid(random, 3, 2);
    RouteOptions options;
    for (int i = 0; i < 6; ++i) {
      const LanePlace at = random_place(random, road_map);
      options.blocked.push_back({at.lane, {at.s_m, at.s_m + 6.0 * unit(random)}});
    }
    Router router(road_map, options), open(road_map);
    for (int i = 0; i < 40; ++i) {
      const LanePlace from = random_place(random, road_map), to = random_place(random, road_map);
      const RouteAnswer answer = router.find(from, to);
      const std::optional<Route> without = open.find(from, to).route;
      tally.none += !answer.route && without;
      if (!answer.route) {
        EXPECT_FALSE(is_reached_by_metres(road_map, from, to, options))
            << road_map.lane(from.lane).name << "@" << from.s_m << " to "
            << road_map.lane(to.lane).name << "@" << to.s_m;
        continue;
      }
      ++tally.found;
      expect_connected(road_map, *answer.route, from, to, options);
      expect_past(road_map, options.blocked, *answer.route);
      ASSERT_TRUE(without);
      EXPECT_GE(answer.route->cost_s, without->cost_s - 1e-3);
      detours += answer.route->cost_s > without->cost_s + 1.0;
    }
  }
  EXPECT_GT(tally.found, 100);
  EXPECT_GT(tally.none, 20);
  EXPECT_GT(detours, 10);
}

TEST(FindRoute, LeavesABlockedLaneBeforeTheBlockAndSaysSoWhereItCannot) {
  const TwoLanes lanes;
  const RoadMap road_map = lanes.made.build();
  RouteOptions options;
  options.blocked = {{lanes.left, {60.0, 65.0}}};
  const LanePlace from{lanes.left, 20.0, 0.0}, to{lanes.after_right, 50.0, 0.0};
  const RouteAnswer answer = find_route(road_map, from, to, options);
  ASSERT_TRUE(answer.route) << answer.reason;
  EXPECT_NEAR(answer.route->legs[0].to_s_m, 40.0, 1e-9);
  EXPECT_NEAR(answer.route->legs[0].change_window->to_s_m, 60.0, 1e-9);
  EXPECT_NEAR(answer.route->cost_s, 130.0 / 13.9 + 5.0, 1e-9);
  options.blocked = {{lanes.left, {29.0, 65.0}}};
  const RouteAnswer none = find_route(road_map, from, to, options);
  EXPECT_FALSE(none.route);
  EXPECT_NE(none.reason.find("between them stand closed lanes"), std::string::npos) << none.reason;
  options.blocked = {{lanes.left, {66.0, 65.0}}};
  EXPECT_THROW(Router(road_map, options), std::invalid_argument);
}

TEST(FindRoute, NeedsTheLengthOfALaneChange) {
  const TwoLanes lanes;
  const RoadMap road_map = lanes.made.build();
  EXPECT_TRUE(find_route(road_map, {lanes.left, 89.9, 0.0}, {lanes.after_right, 50.0, 0.0}).route);
  const RouteAnswer answer =
      find_route(road_map, {lanes.left, 90.1, 0.0}, {lanes.after_right, 50.0, 0.0});
  EXPECT_FALSE(answer.route);
  ASSERT_TRUE(answer.explanation);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::length});
}

TEST(FindRoute, AGoalBehindTheStartOnTheSameLaneTakesALoopOrIsRefused) {
  TwoLanes lanes;
  const LanePlace start{lanes.left, 60.0, 0.0}, goal{lanes.left, 40.0, 0.0};
  EXPECT_FALSE(find_route(lanes.made.build(), start, goal).route);
  lanes.made.link(lanes.after_left, lanes.left);
  const RouteAnswer answer = find_route(lanes.made.build(), start, goal);
  ASSERT_TRUE(answer.route);
  EXPECT_NEAR(answer.route->length_m, 40.0 + 100.0 + 40.0, 1e-9);
  EXPECT_EQ(answer.route->legs.size(), 3U);
}

TEST(FindRoute, StartingAtTheGoalIsARouteOfNoLength) {
  const TwoLanes lanes;
  const LanePlace place{lanes.left, 60.0, 0.0};
  const RouteAnswer answer = find_route(lanes.made.build(), place, place);
  ASSERT_TRUE(answer.route);
  EXPECT_EQ(answer.route->legs.size(), 1U);
  EXPECT_EQ(answer.route->length_m, 0.0);
}

TEST(FindRoute, RefusesLanesThatACarMayNotDriveOn) {
  TwoLanes lanes;
  lanes.made.lane(lanes.right).type = map::LaneType::sidewalk;
  const RoadMap road_map = lanes.made.build();
  const RouteAnswer from = find_route(road_map, {lanes.right, 1, 0}, {lanes.left, 9, 0});
  EXPECT_FALSE(from.route);
  EXPECT_NE(from.reason.find("sidewalk"), std::string::npos);
  EXPECT_FALSE(find_route(road_map, {lanes.left, 1, 0}, {lanes.right, 9, 0}).route);
  EXPECT_FALSE(find_route(road_map, {lanes.left, 1, 0}, {lanes.after_right, 9, 0}).route);
  EXPECT_THROW(find_route(road_map, {LaneId{99}, 1, 0}, {lanes.left, 9, 0}), std::invalid_argument);
  EXPECT_THROW(find_route(road_map, {lanes.left, 101, 0}, {lanes.left, 9, 0}),
               std::invalid_argument);
}

TEST(FindRoute, OfTwoEqualWaysTheLowerIdIsTakenEveryTime) {
  tests::MadeMap made;
  const auto road = made.add_road("1");
  std::vector<LaneId> lanes;
  for (int i = 0; i < 4; ++i) {
    const double x = i == 0 ? 0.0 : i == 3 ? 200.0 : 100.0;
    lanes.push_back(made.add_lane(road, std::to_string(-1 - i), {{x, 0}, {x + 100, 0}},
                                  {{x, -4}, {x + 100, -4}}));
  }
  for (const std::size_t i : {2U, 1U}) {
    made.link(lanes[0], lanes[i]);
    made.link(lanes[i], lanes[3]);
  }
  const RouteAnswer answer = find_route(made.build(), {lanes[0], 0, 0}, {lanes[3], 50, 0});
  ASSERT_TRUE(answer.route);
  EXPECT_EQ(answer.route->legs[1].lane, lanes[1]);
}

}  // namespace
}  // namespace roadbed::planning
