#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using map::RoadMap;

ReferenceLine line_between(const RoadMap& road_map, const map::LanePlace& from,
                           const map::LanePlace& to, const ReferenceLineOptions& options = {}) {
  const RouteAnswer answer = find_route(road_map, from, to);
  EXPECT_TRUE(answer.route) << answer.reason;
  return ReferenceLine::along(road_map, answer.route.value(), options);
}

TEST(ReferenceLineAlong, StraightRoadGivesItsCentrelineFromStartToPastTheGoal) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const ReferenceLine line = line_between(road_map, {{0}, 20, 0}, {{2}, 10, 0});
  EXPECT_NEAR(line.goal_s_m(), 90.0, 1e-3);
  EXPECT_NEAR(line.length_m(), 120.0, 0.1);  // 30 m past the goal
  for (double s = -5.0; s <= 125.0; s += 0.5) {
    const ReferencePoint point = line.at(s);
    EXPECT_NEAR(point.in_map.x(), 20.0 + s, 1e-3);
    EXPECT_NEAR(point.in_map.y(), 0.0, 1e-3);
    EXPECT_NEAR(line.corridor_at(s).left_m, 2.0, 1e-3);
    EXPECT_NEAR(line.corridor_at(s).right_m, 2.0, 1e-3);
    EXPECT_EQ(line.corridor_at(s).speed_limit_mps, 13.9);
  }
}

TEST(ReferenceLineAlong, GoesOnStraightWhereNoLaneFollows) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const ReferenceLine line = line_between(road_map, {{0}, 20, 0}, {{2}, 45, 0});
  EXPECT_NEAR(line.length_m(), 155.0, 0.1);
  EXPECT_NEAR(line.at(150.0).in_map.x(), 170.0, 0.01);
  EXPECT_NEAR(line.corridor_at(150.0).left_m, 2.0, 1e-3);
}

// Two lanes of 200 m eastwards side by side, 4 m wide.
struct TwoLanes {
  tests::MadeMap made;
  LaneId left, right;

  TwoLanes() {
    const auto road = made.add_road("1");
    left = made.add_lane(road, "-1", {{0, 4}, {200, 4}}, {{0, 0}, {200, 0}});
    right = made.add_lane(road, "-2", {{0, 0}, {200, 0}}, {{0, -4}, {200, -4}});
    made.put_beside(left, right);
  }
};

TEST(ReferenceLineAlong, PassesOverToTheOtherLaneWithinTheLengthOfALaneChange) {
  const TwoLanes lanes;
  const RoadMap road_map = lanes.made.build();
  const ReferenceLine line = line_between(road_map, {lanes.left, 0, 0}, {lanes.right, 200, 0});
  EXPECT_NEAR(line.at(75.0).in_map.y(), 2.0, 0.03);
  EXPECT_NEAR(line.at(125.5).in_map.y(), -2.0, 0.03);
  EXPECT_NEAR(line.at(100.0).in_map.y(), 0.0, 0.05);
  const double quintic_peak = 5.7735 * 4.0 / (40.0 * 40.0);
  for (double s = 0.0; s < line.length_m(); s += 0.25) {
    EXPECT_LE(std::abs(line.at(s).curvature_per_m), 1.1 * quintic_peak) << "at " << s << " m";
    const Corridor room = line.corridor_at(s);
    EXPECT_NEAR(room.left_m + room.right_m, 8.0, 0.2) << "both lanes, slanted a little";
    EXPECT_NEAR(room.left_m, 4.0 - line.at(s).in_map.y(), 0.1);
  }
  EXPECT_LE(line.largest_move_m(), 0.05);
}

TEST(ReferenceLineAlong, RoomEndsAtAMarkingThatMayNotBeCrossedAndSpansAnOppositeLaneIfItMay) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto room_at_50 = [&] {
    const RoadMap road_map = made.build();
    return line_between(road_map, {{0}, 0, 0}, {{0}, 100, 0}).corridor_at(50.0);
  };
  EXPECT_NEAR(room_at_50().left_m, 1.75, 1e-3);
  EXPECT_NEAR(room_at_50().right_m, 1.75, 1e-3);
  made.parts.links[0].left->change_windows = {{0.0, made.parts.lanes[0].length_m()}};
  EXPECT_NEAR(room_at_50().left_m, 1.75 + 3.5, 1e-3);
  EXPECT_NEAR(room_at_50().right_m, 1.75, 1e-3);
}

TEST(ReferenceLineAlong, TakesOutAStepBetweenLanes) {
  tests::MadeMap made;
  const auto one = made.add_road("1"), two = made.add_road("2");
  const LaneId first = made.add_lane(one, "-1", {{0, 2}, {100, 2}}, {{0, -2}, {100, -2}});
  const LaneId second = made.add_lane(two, "-1", {{99.9, 3}, {200, 3}}, {{99.9, -1}, {200, -1}});
  made.link(first, second);
  const RoadMap road_map = made.build();
  const ReferenceLine line = line_between(road_map, {first, 0, 0}, {second, 90, 0});
  for (double s = 0.0; s < line.length_m(); s += 0.25) {
    EXPECT_LE(std::abs(line.at(s).curvature_per_m), 0.03) << "at " << s << " m";
    EXPECT_GE(line.at(s).in_map.y(), -0.04);
    EXPECT_LE(line.at(s).in_map.y(), 1.04);
  }
}

TEST(ReferenceLineAlong, StartAtTheGoalStillGivesALineAhead) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const ReferenceLine line = line_between(road_map, {{0}, 0, 0}, {{0}, 0, 0}, {.extend_m = 0.0});
  EXPECT_GE(line.length_m(), 0.9);
  EXPECT_NEAR(line.goal_s_m(), 0.0, 1e-3);
}

// Laws that hold on every line.
void expect_smooth(const ReferenceLine& line, const std::string& name) {
  const double h = 1e-3;
  for (double s = 0.5; s < line.length_m() - 0.5; s += 0.83) {
    const ReferencePoint before = line.at(s - h), here = line.at(s), after = line.at(s + h);
    const Eigen::Vector2d velocity = (after.in_map - before.in_map) / (2.0 * h);
    ASSERT_NEAR(velocity.norm(), 1.0, 1e-6) << name << " at " << s << " m";
    ASSERT_NEAR(here.curvature_per_m, (after.heading_rad - before.heading_rad) / (2.0 * h), 1e-5)
        << name << " at " << s << " m";
    ASSERT_NEAR(here.curvature_d1_per_m2,
                (after.curvature_per_m - before.curvature_per_m) / (2.0 * h), 1e-5)
        << name << " at " << s << " m";
    ASSERT_NEAR(here.curvature_d2_per_m3,
                (after.curvature_d1_per_m2 - before.curvature_d1_per_m2) / (2.0 * h), 1e-4)
        << name << " at " << s << " m";
    const geometry::LinePosition foot = line.project(here.in_map, s + 2.0);
    ASSERT_NEAR(foot.s_m, s, 1e-6) << name;
    ASSERT_NEAR(foot.d_m, 0.0, 1e-9) << name;
  }
}

TEST(ReferenceLineAlong, IsSmoothAndNearTheCentrelineOnRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  for (const char* file :
       {"BerkeleyLearnVerify+Scenic/Town01.xodr", "BerkeleyLearnVerify+Scenic/Town10HD.xodr",
        "esmini+esmini/multi_intersections.xodr"}) {
    const RoadMap road_map = map::load_map(folder / "opendrive" / file);
    std::uniform_int_distribution<std::size_t> any(0, road_map.lanes().size() - 1);
    for (int found = 0, tried = 0; found < 8 && tried < 1000; ++tried) {
      const map::Lane &from = road_map.lanes()[any(random)], &to = road_map.lanes()[any(random)];
      if (!is_drivable(from.type) || !is_drivable(to.type)) continue;
      const RouteAnswer answer = find_route(road_map, {from.id, 0.3 * from.length_m(), 0},
                                            {to.id, 0.7 * to.length_m(), 0});
      if (!answer.route) continue;
      ++found;
      const ReferenceLine line = ReferenceLine::along(road_map, *answer.route);
      expect_smooth(line, from.name + " to " + to.name);
      EXPECT_LE(line.largest_move_m(), 0.31) << from.name << " to " << to.name;
      EXPECT_NEAR(
          (line.at(line.goal_s_m()).in_map - to.pose_at(0.7 * to.length_m()).position()).norm(),
          0.0, 0.31);
    }
  }
}

}  // namespace
}  // namespace roadbed::planning
