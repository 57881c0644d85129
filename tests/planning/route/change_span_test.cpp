#include "roadbed/planning/route/change_span.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_path.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using tests::ShortSections;

constexpr double kLimit_mps = 13.9;  // of made lanes

TEST(ChangeSpan, LeadsOverAChainOfSectionsThatAreEachTooShortForAChange) {
  const ShortSections road(std::vector<double>(20, 4.0));
  const auto road_map = road.made.build();
  const RouteAnswer answer = find_route(road_map, {road.left[0], 0, 0}, {road.right[19], 4, 0});
  ASSERT_TRUE(answer.route);
  EXPECT_EQ(answer.route->lane_changes, 1);
  EXPECT_NEAR(answer.route->cost_s, 80.0 / kLimit_mps + 5.0, 1e-9);
  EXPECT_NEAR(answer.route->length_m, 80.0, 1e-9);
  EXPECT_EQ(answer.route->legs.size(), 21U);
  for (const RouteLeg& leg : answer.route->legs) {
    if (!leg.change_window) continue;
    EXPECT_EQ(leg.exit, LegExit::change_right);
    EXPECT_NEAR(leg.change_window->to_s_m - leg.change_window->from_s_m, 40.0, 1e-6);
    EXPECT_LT(leg.change_window->from_s_m, 0.0);
    EXPECT_GT(leg.change_window->to_s_m, 4.0);
  }
}

TEST(ChangeSpan, CostsMoreInProportionWithLessRoomThanIsComfortable) {
  const ShortSections road({8.0, 8.0});
  const RouteAnswer answer =
      find_route(road.made.build(), {road.left[0], 0, 0}, {road.right[1], 8, 0});
  ASSERT_TRUE(answer.route);
  EXPECT_NEAR(answer.route->cost_s, 16.0 / kLimit_mps + 5.0 * 40.0 / 16.0, 1e-9);
}

TEST(ChangeSpan, HasOnlyTheRoomBetweenStartAndGoal) {
  const ShortSections road({8.0, 8.0, 8.0});
  const auto road_map = road.made.build();
  const RouteAnswer answer = find_route(road_map, {road.left[0], 3, 0}, {road.right[2], 5, 0});
  ASSERT_TRUE(answer.route);
  EXPECT_NEAR(answer.route->cost_s, 18.0 / kLimit_mps + 5.0 * 40.0 / 18.0, 1e-9);
  const RouteAnswer none = find_route(road_map, {road.left[0], 5, 0}, {road.right[1], 6.5, 0});
  ASSERT_FALSE(none.route) << "3 m and 6.5 m are less than 10 m";
  EXPECT_EQ(none.explanation->blocking_rules, std::vector{BlockingRule::length});
  EXPECT_TRUE(find_route(road_map, {road.left[0], 5, 0}, {road.right[1], 7.1, 0}).route);
}

TEST(ChangeSpan, AsksForBothLanesInEverySection) {
  for (const bool left : {true, false}) {
    // 9 m are before the middle section, 9 m behind it, and it is needed for 10 m.
    const ShortSections road({50.0, 4.0, 4.0, 4.0, 50.0});
    const auto road_map = road.made.build();
    const map::LanePlace from{road.left[0], 45, 0}, to{road.right[4], 5, 0};
    EXPECT_TRUE(find_route(road_map, from, to).route);
    RouteOptions options;
    options.avoid = {(left ? road.left : road.right)[2]};
    EXPECT_FALSE(find_route(road_map, from, to, options).route);
  }
}

TEST(ChangeSpan, EndsWhereTheLanesPart) {
  ShortSections road({6.0, 6.0});
  auto& links = road.made.parts.links[road.right[0].index];
  links.successors.clear();
  road.made.parts.links[road.right[1].index].predecessors.clear();
  const RouteAnswer answer =
      find_route(road.made.build(), {road.left[0], 0, 0}, {road.right[1], 6, 0});
  ASSERT_FALSE(answer.route);
  EXPECT_EQ(answer.explanation->blocking_rules, std::vector{BlockingRule::length});
}

// Sections of three lanes eastwards, one behind the other.
struct ThreeLanes {
  tests::MadeMap made;
  std::vector<std::vector<LaneId>> lanes{3};

  explicit ThreeLanes(const std::vector<double>& lengths_m) {
    double from = 0.0;
    for (std::size_t i = 0; i < lengths_m.size(); ++i) {
      const auto road = made.add_road(std::to_string(i));
      const double to = from + lengths_m[i];
      for (std::size_t j = 0; j < 3; ++j) {
        const double y = -4.0 * static_cast<double>(j);
        lanes[j].push_back(made.add_lane(road, std::to_string(-1 - static_cast<int>(j)),
                                         {{from, y}, {to, y}}, {{from, y - 4}, {to, y - 4}}));
        if (j > 0) made.put_beside(lanes[j - 1].back(), lanes[j].back());
        if (i > 0) made.link(lanes[j][i - 1], lanes[j][i]);
      }
      from = to;
    }
  }

  RouteAnswer across(const map::RoadMap& road_map) const {
    const LaneId last = lanes[2].back();
    return find_route(road_map, {lanes[0].front(), 0, 0},
                      {last, road_map.lane(last).length_m(), 0});
  }
};

TEST(ChangeSpan, HoldsTwoChangesThatShareASection) {
  const ThreeLanes road({7.0, 7.0, 7.0});
  const auto road_map = road.made.build();
  const RouteAnswer answer = road.across(road_map);
  ASSERT_TRUE(answer.route) << "21 m are 10.5 m for each";
  EXPECT_EQ(answer.route->lane_changes, 2);
  EXPECT_NEAR(answer.route->cost_s, 21.0 / kLimit_mps + 2 * 5.0 * 40.0 / 10.5, 1e-9);
  const auto& legs = answer.route->legs;
  ASSERT_EQ(legs.size(), 5U);
  EXPECT_EQ(legs[0].exit, LegExit::change_right);
  EXPECT_NEAR(legs[0].change_window->from_s_m, 0.0, 1e-9);
  EXPECT_NEAR(legs[0].change_window->to_s_m, 10.5, 1e-9);
  EXPECT_EQ(legs[2].lane, road.lanes[1][1]) << "the middle lane in the middle section";
  EXPECT_EQ(legs[3].exit, LegExit::change_right);
  EXPECT_NEAR(legs[3].change_window->from_s_m, 10.5 - 14.0, 1e-9);
  EXPECT_NEAR(legs[3].change_window->to_s_m, 7.0, 1e-9);
  RouteOptions options;
  options.avoid = {road.lanes[1][1]};
  EXPECT_FALSE(
      find_route(road_map, {road.lanes[0][0], 0, 0}, {road.lanes[2][2], 7, 0}, options).route);
}

TEST(ChangeSpan, HoldsTwoChangesOverOneSectionEnd) {
  const ThreeLanes road({15.0, 7.0});
  const auto road_map = road.made.build();
  const RouteAnswer answer = road.across(road_map);
  ASSERT_TRUE(answer.route) << "22 m are 11 m for each";
  EXPECT_NEAR(answer.route->cost_s, 22.0 / kLimit_mps + 2 * 5.0 * 40.0 / 11.0, 1e-9);
}

TEST(ChangeSpan, OfTwoChangesNeedsTheLeastLengthTwice) {
  const ThreeLanes road({6.0, 6.0, 7.0});
  EXPECT_FALSE(road.across(road.made.build()).route) << "19 m are 9.5 m for each";
}

TEST(ChangeSpan, OfTwoChangesIsOneSmoothPath) {
  const ThreeLanes road(std::vector<double>(16, 5.0));
  const auto road_map = road.made.build();
  const RouteAnswer answer = road.across(road_map);
  ASSERT_TRUE(answer.route);
  EXPECT_NEAR(answer.route->cost_s, 80.0 / kLimit_mps + 10.0, 1e-9);
  const RoutePath path = path_along(road_map, *answer.route, {.lead_m = 0.0, .extend_m = 0.0});
  double steepest = 0.0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Eigen::Vector2d step = path.points[i].in_map - path.points[i - 1].in_map;
    EXPECT_LE(step.y(), 1e-9) << "never back to the left";
    steepest = std::max(steepest, -step.y() / step.x());
  }
  EXPECT_NEAR(path.points.front().in_map.y(), -2.0, 1e-6);
  EXPECT_NEAR(path.points.back().in_map.y(), -10.0, 1e-6);
  EXPECT_NEAR(steepest, 1.875 * 4.0 / 40.0, 2e-3) << "10t³ − 15t⁴ + 6t⁵ over 40 m each";
}

TEST(ChangeSpan, IsOneSmoothPathWhoseCorridorHoldsBothLanes) {
  const ShortSections road(std::vector<double>(20, 4.0));
  const auto road_map = road.made.build();
  const RouteAnswer answer = find_route(road_map, {road.left[0], 0, 0}, {road.right[19], 4, 0});
  ASSERT_TRUE(answer.route);
  const RoutePath path = path_along(road_map, *answer.route, {});
  double steepest = 0.0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Eigen::Vector2d step = path.points[i].in_map - path.points[i - 1].in_map;
    EXPECT_LE(step.y(), 1e-9) << "never back to the left";
    steepest = std::max(steepest, -step.y() / step.x());
  }
  EXPECT_NEAR(path.points.front().in_map.y(), -2.0, 1e-6);
  EXPECT_NEAR(path.points.back().in_map.y(), -6.0, 1e-6);
  EXPECT_NEAR(steepest, 1.875 * 4.0 / 40.0, 2e-3) << "10t³ − 15t⁴ + 6t⁵ over 40 m";
  double area_m2 = 0.0;
  for (const auto& polygon : area_of(road_map, corridor_of(road_map, *answer.route))) {
    area_m2 += geometry::area_m2(polygon);
  }
  EXPECT_NEAR(area_m2, 80.0 * 4.0 + 40.0 * 4.0, 1e-3);
}

}  // namespace
}  // namespace roadbed::planning
