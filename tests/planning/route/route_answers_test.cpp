// What is made of routes: via points, alternatives, reachable lanes, corridor, instructions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/alternatives.h"
#include "roadbed/planning/route/guidance.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_options.h"
#include "roadbed/planning/route/route_solver.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/mirrored_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using map::LanePlace;

const map::RoadMap& town() {
  static const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  return road_map;
}

LanePlace place(const char* lane, double s_m) { return {*town().find_lane(lane), s_m, 0.0}; }

TEST(Via, CostsAddUpAndTheStopIsKept) {
  Router router(town());
  const LanePlace a = place("1/0/-1", 10.0), b = place("7/0/1", 55.0), c = place("1/0/-1", 14.0);
  const RoutePlace places[] = {a, b, c};
  const RouteAnswer whole = router.find(places);
  ASSERT_TRUE(whole.route) << whole.reason;
  const RouteAnswer first = router.find(a, b), second = router.find(b, c);
  EXPECT_NEAR(whole.route->cost_s, first.route->cost_s + second.route->cost_s, 1e-9);
  EXPECT_NEAR(whole.route->length_m, first.route->length_m + second.route->length_m, 1e-9);
  ASSERT_EQ(whole.route->stops.size(), 1U);
  const RouteStop& stop = whole.route->stops[0];
  EXPECT_EQ(whole.route->legs[stop.leg].lane, b.lane);
  EXPECT_EQ(stop.s_m, 55.0);
  EXPECT_EQ(whole.route->legs.size(), first.route->legs.size() + second.route->legs.size() - 1);
  double cost_s = 0.0;
  for (const RouteLeg& leg : whole.route->legs) cost_s += leg.cost_s;
  EXPECT_NEAR(cost_s, whole.route->cost_s, 1e-9);
}

TEST(Via, ALoopOverTheGoalIsDrivenTwice) {
  Router router(town());
  const LanePlace goal = place("1/0/-1", 14.0);
  const RoutePlace places[] = {place("1/0/-1", 10.0), goal, goal, place("1/0/-1", 11.0)};
  const RouteAnswer answer = router.find(places);
  ASSERT_TRUE(answer.route) << answer.reason;
  EXPECT_EQ(answer.route->stops.size(), 2U);
  EXPECT_GT(answer.route->length_m, 100.0);
}

TEST(Alternatives, DifferAsTheyPromiseAndTheFirstIsTheCheapest) {
  Router router(town());
  const LanePlace from = place("1/0/-1", 10.0), to = place("7/0/1", 55.0);
  const auto found = find_alternatives(router, from, to, {.count = 4});
  ASSERT_GE(found.size(), 2U);
  EXPECT_NEAR(found[0].route.cost_s, router.find(from, to).route->cost_s, 1e-9);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GE(found[i].route.cost_s, found[0].route.cost_s - 1e-3);
    EXPECT_LE(found[i].route.cost_s, 1.5 * found[0].route.cost_s);
    EXPECT_EQ(found[i].route.legs.front().lane, from.lane);
    EXPECT_EQ(found[i].route.legs.back().lane, to.lane);
    double most = 0.0;
    for (std::size_t j = 0; j < i; ++j) {
      most = std::max(most, shared_length_ratio(found[i].route, found[j].route));
    }
    EXPECT_NEAR(found[i].shared, most, 1e-12);
    EXPECT_LE(most, 0.7);
  }
}

// A lane's end is reached within the limit if and only if a route to it costs no more.
TEST(Reach, HoldsWhatRoutesCost) {
  Router router(town());
  const LanePlace from = place("1/0/-1", 10.0);
  const double limit_s = 60.0;
  const auto reached = isochrone(router, from, limit_s);
  ASSERT_GT(reached.size(), 10U);
  int inside = 0, outside = 0;
  for (const map::Lane& lane : town().lanes()) {
    if (lane.id == from.lane || !may_use(lane, map::Participant::car)) continue;
    const auto answer = router.solver().solve(from, {lane.id, lane.length_m(), 0.0});
    const double cost_s = answer ? router.route_along(*answer).cost_s : 1e9;
    const bool whole = std::any_of(reached.begin(), reached.end(), [&](const ReachedLane& part) {
      return part.part.lane == lane.id && part.part.to_s_m >= lane.length_m() - 1e-6;
    });
    if (std::abs(cost_s - limit_s) < 0.01) continue;
    EXPECT_EQ(whole, cost_s < limit_s) << lane.name << " costs " << cost_s;
    ++(whole ? inside : outside);
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(outside, 10);
}

TEST(Reach, EndsWhereTheDistanceIsUsedUp) {
  const map::RoadMap road_map = tests::three_roads_in_a_row().build();
  RouteOptions options;
  options.cost = RouteCost::distance;
  Router router(road_map, options);
  const auto reached = isochrone(router, {LaneId{0}, 20.0, 0.0}, 70.0);
  ASSERT_EQ(reached.size(), 2U);
  EXPECT_NEAR(reached[0].part.from_s_m, 20.0, 1e-9);
  EXPECT_NEAR(reached[0].part.to_s_m, 50.0, 1e-9);
  EXPECT_NEAR(reached[1].cost, 30.0, 1e-9);
  EXPECT_NEAR(reached[1].part.to_s_m, 40.0, 1e-6);
  const auto area = area_of(road_map, {reached[0].part, reached[1].part});
  ASSERT_EQ(area.size(), 1U);
  EXPECT_NEAR(geometry::area_m2(area[0]), 70.0 * 4.0, 1e-6);
  EXPECT_THROW(isochrone(router, {LaneId{0}, 20.0, 0.0}, 0.0), std::invalid_argument);
}

TEST(Corridor, CoversEveryPlaceOfTheRoute) {
  Router router(town());
  const RouteAnswer answer = router.find(place("1/0/-1", 10.0), place("7/0/1", 55.0));
  ASSERT_TRUE(answer.route);
  const auto area = area_of(town(), corridor_of(town(), *answer.route));
  for (const RouteLeg& leg : answer.route->legs) {
    for (const double fraction : {0.01, 0.5, 0.99}) {
      const double s_m = leg.from_s_m + fraction * (leg.to_s_m - leg.from_s_m);
      const Eigen::Vector2d point = town().lane(leg.lane).pose_at(s_m).position();
      EXPECT_TRUE(std::any_of(area.begin(), area.end(), [&](const geometry::Polygon& part) {
        return geometry::contains(part, point);
      }));
    }
  }
}

TEST(Instructions, TellTurnsAtTheirDistancesAndTheArrival) {
  tests::MadeMap made;
  const auto road = made.add_road("1"), end = made.add_road("3");
  made.parts.roads[end.index].name = "Main Street";
  const auto junction = made.add_road("2", made.add_junction("7"));
  const LaneId in = made.add_lane(road, "-1", {{0, 2}, {50, 2}}, {{0, -2}, {50, -2}});
  const LaneId beside = made.add_lane(road, "-2", {{0, -2}, {50, -2}}, {{0, -6}, {50, -6}});
  const LaneId bend = made.add_lane(junction, "-1", {{50, -2}, {56, -2}, {56, -12}},
                                    {{50, -6}, {52, -6}, {52, -12}});
  const LaneId out = made.add_lane(end, "-1", {{56, -12}, {56, -62}}, {{52, -12}, {52, -62}});
  made.put_beside(in, beside);
  made.link(beside, bend);
  made.link(bend, out);
  const map::RoadMap road_map = made.build();
  const RouteAnswer answer = find_route(road_map, {in, 10.0, 0.0}, {out, 20.0, 0.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  const auto told = instructions_for(road_map, *answer.route);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0].text, "in 0 m, change one lane to the right within 40 m");
  EXPECT_EQ(told[1].text, "in 40 m, turn right onto Main Street");
  EXPECT_NEAR(told[1].at_m, 40.0, 1e-9);
  EXPECT_THAT(told[2].text, testing::HasSubstr("arrive at the goal"));
}

TEST(Closures, APolygonClosesTheLanesThatItTouches) {
  const map::RoadMap road_map = tests::three_roads_in_a_row().build();
  using Lanes = std::vector<LaneId>;
  EXPECT_EQ(lanes_touching(road_map, {{10, -1}, {12, -1}, {12, 1}}), Lanes{{0}});
  EXPECT_EQ(lanes_touching(road_map, {{40, -9}, {60, -9}, {60, 9}, {40, 9}}), (Lanes{{0}, {1}}));
  EXPECT_EQ(lanes_touching(road_map, {{-1, -9}, {999, -9}, {999, 9}, {-1, 9}}).size(), 3U);
  EXPECT_TRUE(lanes_touching(road_map, {{10, 3}, {12, 3}, {12, 5}}).empty());
}

// The mirrored road: the left neighbour in driving direction is the lane nearer the edge.
TEST(LeftHandTraffic, ChangesAndTurnsKeepTheirSides) {
  tests::MadeMap made;
  const auto road = made.add_road("1"), next = made.add_road("2");
  const LaneId inner = made.add_lane(road, "1", {{0, 0}, {100, 0}}, {{0, -4}, {100, -4}});
  const LaneId outer = made.add_lane(road, "2", {{0, 4}, {100, 4}}, {{0, 0}, {100, 0}});
  const LaneId after = made.add_lane(next, "2", {{100, 4}, {200, 4}}, {{100, 0}, {200, 0}});
  made.put_beside(outer, inner);
  made.link(outer, after);
  const RouteAnswer answer = find_route(made.build(), {inner, 10.0, 0.0}, {after, 50.0, 0.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  EXPECT_EQ(answer.route->legs[0].exit, LegExit::change_left);
}

TEST(LeftHandTraffic, TakesTheRoutesOfTheMirroredMapWithTheirSidesSwapped) {
  RouteOptions options, swapped;
  options.prices_s.left_turn = swapped.prices_s.right_turn = 7.0;
  options.prices_s.right_turn = swapped.prices_s.left_turn = 2.0;
  const map::RoadMap mirror = tests::mirrored(town().parts());
  Router right_hand(town(), options), left_hand(mirror, swapped);
  const auto told = [](const map::RoadMap& road_map, const Route& route, const char* words) {
    const auto all = instructions_for(road_map, route);
    return std::count_if(all.begin(), all.end(), [&](const Instruction& instruction) {
      return instruction.text.find(words) != std::string::npos;
    });
  };
  std::mt19937 random(20261122);
  const auto any_place = [&] {
    const LaneId lane{static_cast<std::uint32_t>(random() % town().lanes().size())};
    return LanePlace{lane, 0.5 * town().lane(lane).length_m(), 0.0};
  };
  long lefts = 0, rights = 0, u_turns = 0, changes = 0;
  for (int i = 0; i < 400; ++i) {
    const LanePlace from = any_place(), to = any_place();
    const RouteAnswer plain = right_hand.find(from, to), seen = left_hand.find(from, to);
    ASSERT_EQ(plain.route.has_value(), seen.route.has_value());
    if (!plain.route) continue;
    EXPECT_NEAR(plain.route->cost_s, seen.route->cost_s, 1e-3);
    const long left = told(town(), *plain.route, "left"),
               right = told(town(), *plain.route, "right");
    EXPECT_EQ(told(mirror, *seen.route, "right"), left);
    EXPECT_EQ(told(mirror, *seen.route, "left"), right);
    u_turns += told(mirror, *seen.route, "U-turn");
    changes += told(mirror, *seen.route, "change");
    lefts += left;
    rights += right;
  }
  EXPECT_GT(std::min({lefts, rights, changes}), 20);
  EXPECT_NE(lefts, rights);
  EXPECT_GT(u_turns, 0);
}

TEST(Participants, UseTheirOwnLanesOnly) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane({1}).type = map::LaneType::bus;
  made.lane({1}).participants = {map::Participant::bus, map::Participant::emergency};
  const map::RoadMap road_map = made.build();
  RouteOptions options;
  EXPECT_FALSE(find_route(road_map, {{0}, 1, 0}, {{2}, 1, 0}, options).route);
  options.participant = map::Participant::bus;
  EXPECT_TRUE(find_route(road_map, {{0}, 1, 0}, {{2}, 1, 0}, options).route);
}

TEST(Prices, OfTurnsDecideBetweenWays) {
  Router plain(town());
  RouteOptions dear;
  dear.prices_s.left_turn = dear.prices_s.right_turn = 1000.0;
  Router without_turns(town(), dear);
  const LanePlace from = place("1/0/-1", 10.0), to = place("7/0/1", 55.0);
  const auto turns = [](const Route& route) {
    return std::count_if(route.legs.begin(), route.legs.end(), [](const RouteLeg& leg) {
      return leg.turn == Turn::left || leg.turn == Turn::right;
    });
  };
  const RouteAnswer free = plain.find(from, to), priced = without_turns.find(from, to);
  ASSERT_TRUE(free.route && priced.route);
  EXPECT_LE(turns(*priced.route), turns(*free.route));
  EXPECT_GE(priced.route->cost_s, 1000.0 * static_cast<double>(turns(*priced.route)));
}

TEST(UnknownLimits, UseTheDefaultOfTheTypeAndAreCounted) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane({0}).speed_limits = {};
  made.lane({1}).speed_limits = {{0.0, 0.0}};  // zero is no limit either
  made.lane({2}).speed_limits = {};
  made.lane({2}).type = map::LaneType::on_ramp;
  const map::RoadMap road_map = made.build();
  const RouteAnswer answer = find_route(road_map, {{0}, 0, 0}, {{2}, 50, 0});
  ASSERT_TRUE(answer.route);
  EXPECT_EQ(answer.route->legs_of_unknown_speed, 3);
  EXPECT_NEAR(answer.route->cost_s, 100.0 / (50.0 / 3.6) + 50.0 / (60.0 / 3.6), 1e-9);
}

}  // namespace
}  // namespace roadbed::planning
