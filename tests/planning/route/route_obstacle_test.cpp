#include "roadbed/planning/route/route_obstacle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using map::LanePlace;
using testing::HasSubstr;
using tests::TwoLanes;

RouteAnswer no_route(const tests::MadeMap& made, LaneId from, double from_s_m, LaneId to,
                     const RouteOptions& options = {}) {
  RouteAnswer answer = find_route(made.build(), {from, from_s_m, 0}, {to, 10, 0}, options);
  EXPECT_FALSE(answer.route);
  EXPECT_TRUE(answer.obstacle) << answer.reason;
  if (!answer.obstacle) answer.obstacle.emplace();
  return answer;
}

TEST(RouteObstacle, OfAMarkingNamesTheLanesAndBothSides) {
  const TwoLanes lanes(false);
  const RouteAnswer answer = no_route(lanes.made, lanes.left, 10, lanes.after_right);
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::marking});
  EXPECT_EQ(answer.obstacle->lanes_from_start, 2U);
  EXPECT_EQ(answer.obstacle->lanes_to_goal, 2U);
  EXPECT_EQ(answer.obstacle->blocked_from, lanes.left);
  EXPECT_EQ(answer.obstacle->blocked_to, lanes.right);
  EXPECT_THAT(answer.reason, HasSubstr("markings"));
}

TEST(RouteObstacle, OfAClosureNamesTheClosedLane) {
  const TwoLanes lanes;
  RouteOptions options;
  options.avoid = {lanes.after_left};
  lanes.made.build();
  tests::MadeMap made = lanes.made;
  const auto road = made.add_road("3");
  const LaneId end = made.add_lane(road, "-1", {{200, 0}, {300, 0}}, {{200, -4}, {300, -4}});
  made.link(lanes.after_left, end);
  const RouteAnswer answer = no_route(made, lanes.left, 10, end, options);
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::closed});
  EXPECT_EQ(answer.obstacle->blocked_to, lanes.after_left);
  EXPECT_NEAR(answer.obstacle->gap_m, 4.0, 1e-9);
  EXPECT_THAT(answer.reason, HasSubstr("closed"));
}

TEST(RouteObstacle, OfShortLanesSaysSo) {
  const TwoLanes lanes;
  const RouteAnswer answer = no_route(lanes.made, lanes.left, 95, lanes.after_right);
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::length});
  EXPECT_THAT(answer.reason, HasSubstr("too short"));
}

TEST(RouteObstacle, OfOtherUsersLanesSaysSo) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane({1}).participants = {map::Participant::bus};
  const RouteAnswer answer = no_route(made, {0}, 10, {2});
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::participant});
  EXPECT_EQ(answer.obstacle->blocked_to, LaneId{1});
  EXPECT_THAT(answer.reason, HasSubstr("other road users"));
  EXPECT_TRUE(find_route(made.build(), {{0}, 1, 0}, {{1}, 1, 0}).reason.find("car") !=
              std::string::npos);
}

TEST(RouteObstacle, OfOneWayLanesSaysSo) {
  const tests::MadeMap made = tests::three_roads_in_a_row();
  const RouteAnswer answer = no_route(made, {2}, 10, {0});
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::one_way});
  EXPECT_THAT(answer.reason, HasSubstr("other direction"));
}

TEST(RouteObstacle, OfAMapGapGivesItsLength) {
  tests::MadeMap made;
  const auto road = made.add_road("1"), other = made.add_road("2");
  const LaneId a = made.add_lane(road, "-1", {{0, 0}, {50, 0}}, {{0, -4}, {50, -4}});
  const LaneId b = made.add_lane(other, "-1", {{50.3, 0}, {90, 0}}, {{50.3, -4}, {90, -4}});
  const RouteAnswer answer = no_route(made, a, 10, b);
  EXPECT_EQ(answer.obstacle->barriers, std::vector{Barrier::map_gap});
  EXPECT_NEAR(answer.obstacle->gap_m, 0.3, 1e-9);
  EXPECT_EQ(answer.obstacle->gap_from, a);
  EXPECT_EQ(answer.obstacle->gap_to, b);
  EXPECT_THAT(answer.reason, HasSubstr("0.30 m"));
}

TEST(RouteObstacle, OfTwoRulesTogetherNamesBothAndNoOther) {
  const TwoLanes lanes(false);
  RouteOptions options;
  tests::MadeMap made = lanes.made;
  const auto road = made.add_road("3");
  const LaneId end = made.add_lane(road, "-2", {{200, -4}, {300, -4}}, {{200, -8}, {300, -8}});
  made.link(lanes.after_right, end);
  options.avoid = {lanes.after_right};
  const RouteAnswer answer = no_route(made, lanes.left, 10, end, options);
  EXPECT_EQ(answer.obstacle->barriers, (std::vector{Barrier::marking, Barrier::closed}));
}

TEST(RouteObstacle, IsNotAskedForWhereStartOrGoalIsClosed) {
  const TwoLanes lanes;
  RouteOptions options;
  options.avoid = {lanes.left};
  const auto road_map = lanes.made.build();
  const RouteAnswer answer =
      find_route(road_map, {lanes.left, 1, 0}, {lanes.after_left, 1, 0}, options);
  EXPECT_FALSE(answer.route);
  EXPECT_FALSE(answer.obstacle);
  EXPECT_THAT(answer.reason, HasSubstr("start is on lane 1/0/-1, which is closed"));
  EXPECT_THAT(find_route(road_map, {lanes.right, 1, 0}, {lanes.left, 1, 0}, options).reason,
              HasSubstr("goal is on lane 1/0/-1, which is closed"));
}

}  // namespace
}  // namespace roadbed::planning
