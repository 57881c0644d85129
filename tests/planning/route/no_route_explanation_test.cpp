#include "roadbed/planning/route/no_route_explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/planning/route/router.h"
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
  EXPECT_TRUE(answer.explanation) << answer.reason;
  if (!answer.explanation) answer.explanation.emplace();
  return answer;
}

TEST(NoRouteExplanation, OfAMarkingNamesTheLanesAndBothSides) {
  const TwoLanes lanes(false);
  const RouteAnswer answer = no_route(lanes.made, lanes.left, 10, lanes.after_right);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::marking});
  EXPECT_EQ(answer.explanation->lanes_from_start, 2U);
  EXPECT_EQ(answer.explanation->lanes_to_goal, 2U);
  EXPECT_EQ(answer.explanation->blocked_from, lanes.left);
  EXPECT_EQ(answer.explanation->blocked_to, lanes.right);
  EXPECT_THAT(answer.reason, HasSubstr("markings"));
}

TEST(NoRouteExplanation, OfAClosureNamesTheClosedLane) {
  const TwoLanes lanes;
  RouteOptions options;
  options.avoid = {lanes.after_left};
  lanes.made.build();
  tests::MadeMap made = lanes.made;
  const auto road = made.add_road("3");
  const LaneId end = made.add_lane(road, "-1", {{200, 0}, {300, 0}}, {{200, -4}, {300, -4}});
  made.link(lanes.after_left, end);
  const RouteAnswer answer = no_route(made, lanes.left, 10, end, options);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::closed});
  EXPECT_EQ(answer.explanation->blocked_to, lanes.after_left);
  EXPECT_NEAR(answer.explanation->gap_m, 4.0, 1e-9);
  EXPECT_THAT(answer.reason, HasSubstr("closed"));
}

TEST(NoRouteExplanation, OfShortLanesSaysSo) {
  const TwoLanes lanes;
  const RouteAnswer answer = no_route(lanes.made, lanes.left, 95, lanes.after_right);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::length});
  EXPECT_THAT(answer.reason, HasSubstr("too short"));
}

TEST(NoRouteExplanation, OfOtherUsersLanesSaysSo) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane({1}).participants = {map::Participant::bus};
  const RouteAnswer answer = no_route(made, {0}, 10, {2});
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::participant});
  EXPECT_EQ(answer.explanation->blocked_to, LaneId{1});
  EXPECT_THAT(answer.reason, HasSubstr("other road users"));
  EXPECT_TRUE(find_route(made.build(), {{0}, 1, 0}, {{1}, 1, 0}).reason.find("car") !=
              std::string::npos);
}

TEST(NoRouteExplanation, OfOneWayLanesSaysSo) {
  const tests::MadeMap made = tests::three_roads_in_a_row();
  const RouteAnswer answer = no_route(made, {2}, 10, {0});
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::one_way});
  EXPECT_THAT(answer.reason, HasSubstr("other direction"));
}

TEST(NoRouteExplanation, OfAMapGapGivesItsLength) {
  tests::MadeMap made;
  const auto road = made.add_road("1"), other = made.add_road("2");
  const LaneId a = made.add_lane(road, "-1", {{0, 0}, {50, 0}}, {{0, -4}, {50, -4}});
  const LaneId b = made.add_lane(other, "-1", {{50.3, 0}, {90, 0}}, {{50.3, -4}, {90, -4}});
  const RouteAnswer answer = no_route(made, a, 10, b);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::map_gap});
  EXPECT_NEAR(answer.explanation->gap_m, 0.3, 1e-9);
  EXPECT_EQ(answer.explanation->gap_from, a);
  EXPECT_EQ(answer.explanation->gap_to, b);
  EXPECT_THAT(answer.reason, HasSubstr("0.30 m"));
}

TEST(NoRouteExplanation, OfTwoRulesTogetherNamesBothAndNoOther) {
  const TwoLanes lanes(false);
  RouteOptions options;
  tests::MadeMap made = lanes.made;
  const auto road = made.add_road("3");
  const LaneId end = made.add_lane(road, "-2", {{200, -4}, {300, -4}}, {{200, -8}, {300, -8}});
  made.link(lanes.after_right, end);
  options.avoid = {lanes.after_right};
  const RouteAnswer answer = no_route(made, lanes.left, 10, end, options);
  EXPECT_EQ(answer.explanation->blocking_rules,
            (std::vector{BlockingRule::marking, BlockingRule::closed}));
}

TEST(NoRouteExplanation, IsNotAskedForWhereStartOrGoalIsClosed) {
  const TwoLanes lanes;
  RouteOptions options;
  options.avoid = {lanes.left};
  const auto road_map = lanes.made.build();
  const RouteAnswer answer =
      find_route(road_map, {lanes.left, 1, 0}, {lanes.after_left, 1, 0}, options);
  EXPECT_FALSE(answer.route);
  EXPECT_FALSE(answer.explanation);
  EXPECT_THAT(answer.reason, HasSubstr("start is on lane 1/0/-1, which is closed"));
  EXPECT_THAT(find_route(road_map, {lanes.right, 1, 0}, {lanes.left, 1, 0}, options).reason,
              HasSubstr("goal is on lane 1/0/-1, which is closed"));
}

}  // namespace
}  // namespace roadbed::planning
