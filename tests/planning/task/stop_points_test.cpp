#include "roadbed/planning/task/stop_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/mirrored_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/cli/place.h"

namespace roadbed::tools {
namespace {

struct Found {
  std::vector<planning::StopPoint> places;
  std::vector<Eigen::Vector2d> in_source;  ///< of each
};

/// Waiting places between two places of a map.
Found found(const map::RoadMap& road_map, const std::string& from, const std::string& to,
            const std::vector<planning::LightCycle>& lights) {
  const auto answer = planning::find_route(road_map, find_place(road_map, from).for_route(),
                                           find_place(road_map, to).for_route());
  if (!answer.route) throw std::invalid_argument(answer.reason);
  const auto line = planning::ReferenceLine::along(road_map, *answer.route);
  Found result{stop_points(road_map, *answer.route, line, lights), {}};
  for (const planning::StopPoint& place : result.places) {
    result.in_source.push_back(road_map.to_source(line.at(place.s_m).in_map));
  }
  return result;
}

map::RoadMap town() { return map::load_map(tests::data_folder() / "town.xodr"); }

const std::vector<planning::LightCycle> kWestLight{
    {.signals = {"2"}, .pointer = "", .phases = {{planning::LightColour::red, 1.0}}}};

TEST(WaitingPlaces, LightOfTheScenarioHoldsWhereItStands) {
  // The western leg of the crossroads ends at x = 280 m; the light stands 1 m before.
  const Found way = found(town(), "lane:1/3/1@6", "lane:2/3/-1@30", kWestLight);
  ASSERT_EQ(way.places.size(), 1U);
  EXPECT_EQ(way.places[0].kind, planning::StopKind::light);
  EXPECT_EQ(way.places[0].light, 0U);
  EXPECT_NEAR(way.in_source[0].x(), 279.0, 0.2);
  EXPECT_NEAR(way.places[0].clear_s_m - way.places[0].s_m, 41.0, 0.5);  // past the crossing
}

TEST(WaitingPlaces, LightThatTheScenarioDoesNotNameIsDark) {
  EXPECT_TRUE(found(town(), "lane:1/3/1@6", "lane:2/3/-1@30", {}).places.empty());
}

TEST(WaitingPlaces, LeftTurnWaitsBeforeTheOncomingLane) {
  // The oncoming lane's southern border is y = 200 m or a little above; the turn comes from y <
  // 200.
  const Found way = found(town(), "lane:1/3/1@6", "lane:3/1/-1@30", kWestLight);
  ASSERT_EQ(way.places.size(), 2U);
  EXPECT_EQ(way.places[1].kind, planning::StopKind::turn);
  EXPECT_GT(way.in_source[1].x(), 279.2);
  EXPECT_LT(way.in_source[1].x(), 300.0);
  EXPECT_LT(way.in_source[1].y(), 203.0);
}

TEST(WaitingPlaces, LightsAtOneLineAreAllThere) {
  map::RoadMapParts parts = town().parts();
  const auto west = std::ranges::find(parts.signals, "2", &map::Signal::source_id);
  ASSERT_NE(west, parts.signals.end());
  map::Signal second = *west;
  second.source_id = "2b";
  parts.signals.push_back(second);
  std::vector<planning::LightCycle> lights = kWestLight;
  lights.push_back(
      {.signals = {"2b"}, .pointer = "", .phases = {{planning::LightColour::green, 1.0}}});
  const Found way = found(map::RoadMap(std::move(parts)), "lane:1/3/1@6", "lane:2/3/-1@30", lights);
  ASSERT_EQ(way.places.size(), 2U);
  EXPECT_NE(way.places[0].light, way.places[1].light);
  for (const planning::StopPoint& place : way.places) {
    EXPECT_EQ(place.name, place.light == 0U ? "light 2" : "light 2b");
  }
}

TEST(WaitingPlaces, InLeftHandTrafficTheRightTurnWaitsBeforeTheOncomingLane) {
  const map::RoadMap mirror = tests::mirrored(town().parts());
  const Found left_hand = found(mirror, "lane:1/3/1@6", "lane:3/1/-1@30", kWestLight);
  const Found right_hand = found(town(), "lane:1/3/1@6", "lane:3/1/-1@30", kWestLight);
  ASSERT_EQ(left_hand.places.size(), 2U);
  EXPECT_EQ(left_hand.places[1].kind, planning::StopKind::turn);
  EXPECT_EQ(left_hand.places[1].name, "right turn");
  EXPECT_NEAR(left_hand.places[1].s_m, right_hand.places[1].s_m, 0.1);
  EXPECT_TRUE(found(mirror, "lane:1/3/1@6", "lane:4/1/-1@5", {}).places.empty());
}

TEST(WaitingPlaces, RightTurnCrossesNobody) {
  EXPECT_TRUE(found(town(), "lane:1/3/1@6", "lane:4/1/-1@5", {}).places.empty());
}

TEST(WaitingPlaces, GiveWaySignHoldsAtTheRoundabout) {
  // Sign 7 stands 1 m before the end of Main Street, x = 460 m.
  const Found way = found(town(), "lane:2/3/-1@5", "lane:7/0/1@40", {});
  ASSERT_EQ(way.places.size(), 1U);
  EXPECT_EQ(way.places[0].kind, planning::StopKind::give_way);
  EXPECT_NEAR(way.in_source[0].x(), 459.0, 0.2);
}

}  // namespace
}  // namespace roadbed::tools
