// Lanes of both directions, driven against their own.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/guidance.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_path.h"
#include "roadbed/planning/route/route_solver.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/two_way_oracle.h"

namespace roadbed::planning {
namespace {

using map::LaneId;

tests::MadeMap both_ways(tests::MadeMap made) {
  for (map::Lane& lane : made.parts.lanes) lane.one_way = false;
  return made;
}

// Three lanes of 50 m in a row, eastwards, of both directions.
map::RoadMap row() { return both_ways(tests::three_roads_in_a_row()).build(); }

RouteOptions only_lengths(map::Participant user) {
  RouteOptions options;
  options.cost = RouteCost::distance;
  options.participant = user;
  options.prices_m = {};
  options.least_lane_change_m = 1e9;  // no changes
  return options;
}

TEST(TwoWayLanes, AreDrivenBackwardsWithFallingStations) {
  const map::RoadMap road_map = row();
  const RouteAnswer answer = find_route(road_map, {LaneId{2}, 40.0}, {LaneId{0}, 10.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  const auto& legs = answer.route->legs;
  ASSERT_EQ(legs.size(), 3U);
  const double from_m[] = {40.0, 50.0, 50.0}, to_m[] = {0.0, 0.0, 10.0};
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(legs[i].lane, LaneId{2 - i});
    EXPECT_TRUE(legs[i].reversed);
    EXPECT_NEAR(legs[i].from_s_m, from_m[i], 1e-9);
    EXPECT_NEAR(legs[i].to_s_m, to_m[i], 1e-9);
    EXPECT_NEAR(legs[i].length_m, from_m[i] - to_m[i], 1e-9);
  }
  EXPECT_NEAR(answer.route->length_m, 130.0, 1e-9);
  EXPECT_NEAR(answer.route->cost_s, 130.0 / 13.9, 1e-3);
  EXPECT_NEAR(instructions_for(road_map, *answer.route).back().at_m, 130.0, 1e-9);
}

TEST(TwoWayLanes, ThatAreOneWayAreNot) {
  const RouteAnswer answer =
      find_route(tests::three_roads_in_a_row().build(), {LaneId{2}, 40.0}, {LaneId{0}, 10.0});
  ASSERT_TRUE(answer.explanation);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::one_way});
}

TEST(TwoWayLanes, LeadBackToAPlaceBehindOnTheSameLane) {
  const map::RoadMap road_map = row();
  const RouteAnswer answer = find_route(road_map, {LaneId{1}, 40.0}, {LaneId{1}, 10.0});
  ASSERT_TRUE(answer.route);
  EXPECT_EQ(answer.route->legs.size(), 1U);
  EXPECT_NEAR(answer.route->length_m, 30.0, 1e-9);
  EXPECT_TRUE(answer.route->legs.front().reversed);
}

TEST(TwoWayLanes, AreDrivenAsTheHeadingAsks) {
  const map::RoadMap road_map = row();
  const map::LanePlace from{LaneId{1}, 20.0, 0.0}, to{LaneId{1}, 30.0, 0.0};
  EXPECT_TRUE(find_route(road_map, {from, Sense::along}, to).route);
  // There is no place to turn round.
  EXPECT_FALSE(find_route(road_map, {from, Sense::against}, to).route);
  EXPECT_FALSE(find_route(road_map, from, {to, Sense::against}).route);
  EXPECT_TRUE(find_route(road_map, to, {from, Sense::against}).route);
}

TEST(TwoWayLanes, AreNotTurnedOnAtAViaPoint) {
  const map::RoadMap road_map = row();
  Router router(road_map);
  const std::vector<RoutePlace> back_and_forth{
      {LaneId{0}, 10.0}, {LaneId{1}, 25.0}, {LaneId{0}, 40.0}};
  EXPECT_FALSE(router.find(back_and_forth).route);
  const std::vector<RoutePlace> through{{LaneId{2}, 10.0}, {LaneId{1}, 25.0}, {LaneId{0}, 40.0}};
  const RouteAnswer answer = router.find(through);
  ASSERT_TRUE(answer.route) << answer.reason;
  ASSERT_EQ(answer.route->stops.size(), 1U);
  EXPECT_NEAR(answer.route->stops.front().s_m, 25.0, 1e-9);
  EXPECT_NEAR(answer.route->length_m, 70.0, 1e-9);
  const auto told = instructions_for(road_map, *answer.route);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_NEAR(told.front().at_m, 35.0, 1e-9);
}

TEST(TwoWayLanes, AreMatchedWithBothHeadings) {
  const map::RoadMap road_map = row();
  const auto match = [&](std::optional<double> heading_rad) {
    return match_place(road_map, {60.0, 0.5}, heading_rad).front();
  };
  EXPECT_EQ(match({}).sense, Sense::either);
  EXPECT_EQ(match(0.1).sense, Sense::along);
  const PlaceCandidate back = match(3.0);
  EXPECT_EQ(back.verdict, MatchVerdict::chosen);
  EXPECT_EQ(back.sense, Sense::against);
  EXPECT_NEAR(std::abs(back.heading_rad), std::numbers::pi, 1e-9);
  EXPECT_NEAR(back.misfit_m, 2.0 * (std::numbers::pi - 3.0) + 0.05, 1e-9);
}

TEST(TwoWayLanes, AreReachedInBothDirections) {
  const map::RoadMap road_map = row();
  RouteOptions options;
  options.cost = RouteCost::distance;
  Router router(road_map, options);
  std::vector<LanePart> parts;
  std::vector<bool> reversed;
  for (const ReachedLane& lane : isochrone(router, {LaneId{1}, 20.0}, 60.0)) {
    parts.push_back(lane.part);
    reversed.push_back(lane.reversed);
    EXPECT_EQ(lane.reversed, lane.part.to_s_m < lane.part.from_s_m);
  }
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_NEAR(parts[0].from_s_m, 50.0, 1e-9);
  EXPECT_NEAR(parts[0].to_s_m, 10.0, 1e-6);
  EXPECT_NEAR(parts[3].to_s_m, 30.0, 1e-6);
  EXPECT_EQ(reversed, (std::vector{true, false, true, false}));
  double area_m2 = 0.0;
  for (const auto& polygon : area_of(road_map, parts)) area_m2 += geometry::area_m2(polygon);
  EXPECT_NEAR(area_m2, 4.0 * 120.0, 0.1);
}

TEST(TwoWayLanes, GiveALineThatPointsBackAndItsRoomOnTheRightSides) {
  tests::MadeMap made = both_ways(tests::straight_two_lane_road());
  made.lane({1}).one_way = true;
  const map::RoadMap road_map = made.build();
  // Lane 1/0/-1 runs eastwards, y from −3.5 to 0; westwards its left border is at y = −3.5.
  const RouteAnswer answer = find_route(road_map, {LaneId{0}, 80.0}, {LaneId{0}, 20.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  const auto line = ReferenceLine::along(road_map, *answer.route);
  EXPECT_NEAR(line.goal_s_m(), 60.0, 1e-6);
  for (const double s_m : {0.0, 30.0, 60.0}) {
    const ReferencePoint point = line.at(s_m);
    EXPECT_NEAR(point.in_map.x(), 80.0 - s_m, 1e-3);
    EXPECT_NEAR(point.in_map.y(), -1.75, 1e-3);
    EXPECT_NEAR(std::abs(point.heading_rad), std::numbers::pi, 1e-3);
    EXPECT_NEAR(line.corridor_at(s_m).left_m, 1.75, 1e-3);
    EXPECT_NEAR(line.corridor_at(s_m).right_m, 1.75, 1e-3);
  }
}

TEST(TwoWayLanes, AreChangedBetweenTheOtherWayRound) {
  tests::TwoLanes lanes(true);
  const map::RoadMap road_map = both_ways(lanes.made).build();
  const RouteAnswer answer = find_route(road_map, {lanes.right, 90.0}, {lanes.left, 10.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  const auto& legs = answer.route->legs;
  ASSERT_EQ(legs.size(), 2U);
  // Southern lane to northern one, westwards: to the right.
  EXPECT_EQ(legs[0].exit, LegExit::change_right);
  EXPECT_NEAR(legs[0].from_s_m, 90.0, 1e-9);
  EXPECT_NEAR(legs[0].change_window->from_s_m, 90.0, 1e-6);
  EXPECT_NEAR(legs[0].change_window->to_s_m, 10.0, 1e-6);
  EXPECT_NEAR(legs[1].to_s_m, 10.0, 1e-9);
  const RoutePath path = path_along(road_map, *answer.route, {.lead_m = 0.0, .extend_m = 0.0});
  EXPECT_NEAR((path.points.front().in_map - Eigen::Vector2d(90.0, -6.0)).norm(), 0.0, 0.01);
  EXPECT_NEAR((path.points.back().in_map - Eigen::Vector2d(10.0, -2.0)).norm(), 0.0, 1.1);
  double area_m2 = 0.0;
  for (const auto& polygon : area_of(road_map, corridor_of(road_map, *answer.route))) {
    area_m2 += geometry::area_m2(polygon);
  }
  EXPECT_NEAR(area_m2, 8.0 * 80.0, 0.1);
}

// Two lanes that end head to head: only one of them has to be of both directions.
TEST(TwoWayLanes, MeetHeadToHead) {
  tests::MadeMap made;
  made.parts.format = "made";
  const auto road = made.add_road("1");
  const LaneId east = made.add_lane(road, "-1", {{0, 0}, {50, 0}}, {{0, -4}, {50, -4}});
  const LaneId west = made.add_lane(road, "1", {{90, -4}, {50, -4}}, {{90, 0}, {50, 0}});
  made.lane(west).one_way = false;
  const map::RoadMap road_map = made.build();
  const RouteAnswer there = find_route(road_map, {east, 10.0}, {west, 15.0});
  ASSERT_TRUE(there.route) << there.reason;
  EXPECT_NEAR(there.route->length_m, 65.0, 1e-9);
  EXPECT_FALSE(there.route->legs[0].reversed);
  EXPECT_TRUE(there.route->legs[1].reversed);
  EXPECT_FALSE(find_route(road_map, {west, 15.0}, {east, 10.0}).route) << "east is one way";
}

// Driven westwards, lane b leads to the reversed lane a, and bends off into lane c, which starts
// where b does: only b's twin has that choice.
TEST(TwoWayLanes, GiveATurnToWhatTheyLeaveAChoiceOf) {
  tests::MadeMap made;
  made.parts.format = "made";
  const auto road = made.add_road("1");
  const LaneId a = made.add_lane(road, "1", {{0, 0}, {50, 0}}, {{0, -4}, {50, -4}});
  const LaneId b = made.add_lane(road, "2", {{50, 0}, {100, 0}}, {{50, -4}, {100, -4}});
  const LaneId c =
      made.add_lane(road, "3", {{50, -4}, {46, -4}, {46, -44}}, {{50, 0}, {42, 0}, {42, -44}});
  made.link(a, b);
  made.lane(a).one_way = made.lane(b).one_way = false;
  const map::RoadMap road_map = made.build();
  EXPECT_EQ(make_route_network(road_map).lanes[c.index].turn, Turn::left);
  const RouteAnswer answer = find_route(road_map, {b, 40.0}, {c, 30.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  ASSERT_EQ(answer.route->legs.size(), 2U);
  EXPECT_TRUE(answer.route->legs[0].reversed);
  EXPECT_EQ(answer.route->legs[1].turn, Turn::left);
  made.lane(a).one_way = made.lane(b).one_way = true;
  EXPECT_EQ(make_route_network(made.build()).lanes[c.index].turn, Turn::none);
}

TEST(TwoWayLanes, AreStoredWithTheNetwork) {
  const RouteNetwork network = make_route_network(row());
  ASSERT_EQ(network.lanes.size(), 6U);
  const std::string bytes = write_route_network(network);
  const auto read = read_route_network(bytes, 3);
  ASSERT_TRUE(read);
  EXPECT_EQ(write_route_network(*read), bytes);
  EXPECT_TRUE(read->is_reversed(4));
  EXPECT_EQ(read->on_map(4), LaneId{1});
  EXPECT_THROW(read_route_network(bytes, 4), std::invalid_argument);
  EXPECT_THROW(read_route_network(bytes, 6), std::invalid_argument);
}

// Every answer against Dijkstra over the map itself; legs follow each other and add up.
int compare(const map::RoadMap& road_map, map::Participant user, int queries,
            std::mt19937& random) {
  tests::TwoWayOracle oracle(road_map, user);
  Router router(road_map, only_lengths(user));
  int reversed = 0;
  for (int i = 0; i < queries;) {
    const auto any_place = [&] {
      for (;;) {
        const LaneId lane{static_cast<std::uint32_t>(random() % road_map.lanes().size())};
        const double fraction = 0.1 * static_cast<double>(random() % 11);
        const map::LanePlace place{lane, fraction * road_map.lane(lane).length_m(), 0.0};
        if (router.is_fit(place)) return place;
      }
    };
    const map::LanePlace from = any_place(), to = any_place();
    ++i;
    const double expected_m = oracle.length_m(from, to);
    const auto way = router.solver().solve(from, to);
    EXPECT_EQ(way.has_value(), std::isfinite(expected_m))
        << road_map.lane(from.lane).name << " to " << road_map.lane(to.lane).name;
    if (!way || !std::isfinite(expected_m)) continue;
    const Route route = router.route_along(*way);
    EXPECT_NEAR(route.length_m, expected_m, 2e-3 * static_cast<double>(route.legs.size()));
    double length_m = 0.0;
    for (const RouteLeg& leg : route.legs) {
      length_m += leg.reversed ? leg.from_s_m - leg.to_s_m : leg.to_s_m - leg.from_s_m;
      reversed += leg.reversed ? 1 : 0;
    }
    EXPECT_NEAR(length_m, route.length_m, 1e-6);
    EXPECT_EQ(route.legs.back().lane, to.lane);
    EXPECT_NEAR(route.legs.back().to_s_m, to.s_m, 1e-6);
  }
  return reversed;
}

TEST(TwoWayLanes, OfRealMapsCostWhatBoostFinds) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  const auto example = map::load_map(
      folder / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm");
  EXPECT_GT(compare(example, map::Participant::car, 1500, random), 100);
  EXPECT_GT(compare(example, map::Participant::pedestrian, 1500, random), 30);
  EXPECT_GT(compare(example, map::Participant::bicycle, 1500, random), 100);
  compare(map::load_map(folder / "lanelet2/autowarefoundation+autoware_core/intersection.osm"),
          map::Participant::pedestrian, 500, random);
}

TEST(TwoWayLanes, CostWhatBoostFindsWhereAllLanesAreOfBothDirections) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  for (const char* file :
       {"BerkeleyLearnVerify+Scenic/Town01.xodr", "maliput+maliput_malidrive/cloverleaf.xodr",
        "esmini+esmini/multi_intersections.xodr"}) {
    SCOPED_TRACE(file);
    map::RoadMapParts parts = map::load_map(folder / "opendrive" / file).parts();
    for (map::Lane& lane : parts.lanes) lane.one_way = false;
    EXPECT_GT(compare(map::RoadMap(std::move(parts)), map::Participant::car, 500, random), 100);
  }
}

}  // namespace
}  // namespace roadbed::planning
