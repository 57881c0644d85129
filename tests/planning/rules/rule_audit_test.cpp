#include "roadbed/planning/rules/rule_audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using map::MarkType;
using testing::IsEmpty;
using testing::SizeIs;

const geometry::BodyPart kBody = geometry::body_of({});

Trajectory line(double from_x, double from_y, double to_x, double to_y, double speed_mps = 10.0) {
  const double way_m = std::hypot(to_x - from_x, to_y - from_y);
  const double heading_rad = std::atan2(to_y - from_y, to_x - from_x);
  return Trajectory(
      {{.t_s = 0.0, .x_m = from_x, .y_m = from_y, .heading_rad = heading_rad},
       {.t_s = way_m / speed_mps, .x_m = to_x, .y_m = to_y, .heading_rad = heading_rad}});
}

RuleReport audited(const tests::MadeMap& made, TrafficRule rule, const Trajectory& drive,
                   std::span<const LightCycle> lights = {}) {
  const map::RoadMap road_map = made.build();
  return audit_rules({&road_map, lights}, drive, kBody)[static_cast<std::size_t>(rule)];
}

TEST(RuleAudit, TellsDrivesAgainstTheLaneFromThoseAlongIt) {
  const tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto verdict = [&](const Trajectory& drive) {
    return audited(made, TrafficRule::direction, drive).verdict;
  };
  EXPECT_EQ(verdict(line(10, -1.75, 60, -1.75)), Verdict::clear);
  EXPECT_EQ(verdict(line(60, -1.75, 10, -1.75)), Verdict::conflict);
  EXPECT_EQ(verdict(line(60, 1.75, 10, 1.75)), Verdict::clear);
  EXPECT_EQ(verdict(line(10, 20, 60, 20)), Verdict::unknown);  // on no lane
  // Backwards out of the lane's direction: it is the way that counts, not where the nose points.
  Trajectory reverse(
      {{.t_s = 0.0, .x_m = 60, .y_m = -1.75}, {.t_s = 5.0, .x_m = 50, .y_m = -1.75}});
  EXPECT_EQ(verdict(reverse), Verdict::conflict);
}

TEST(RuleAudit, TellsWhereTheAxleEntersTheOncomingLane) {
  const RuleReport report =
      audited(tests::straight_two_lane_road(100.0), TrafficRule::direction, line(10, -2, 90, 2));
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_NEAR(report.violations.front().at.x_m, 50.0, 0.4);  // y = 0
  EXPECT_EQ(report.violations.front().lane, "1/0/1");
}

TEST(RuleAudit, JudgesSlowDrivesByTheirWayHoweverDenseTheirRows) {
  const tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto crawl = [](double step_m) {
    std::vector<geometry::TrajectoryPoint> rows;
    for (int i = 0; i * std::abs(step_m) < 3.0; ++i) {
      rows.push_back({.t_s = 0.001 * i, .x_m = 50.0 + i * step_m, .y_m = 1.75});
    }
    return Trajectory(rows);
  };
  EXPECT_EQ(audited(made, TrafficRule::direction, crawl(0.0005)).verdict, Verdict::conflict);
  EXPECT_EQ(audited(made, TrafficRule::direction, crawl(-0.0005)).verdict, Verdict::clear);
}

TEST(RuleAudit, TakesSpeedsFromTheWayAndNotFromTheRoundingOfARow) {
  const tests::MadeMap made = tests::straight_two_lane_road(100.0);
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i < 3000; ++i) {  // 13 m/s in millimetres, ±1 m/s from row to row
    rows.push_back({.t_s = 0.001 * i, .x_m = 20.0 + 0.013 * i + 0.001 * (i % 2), .y_m = -1.75});
  }
  EXPECT_EQ(audited(made, TrafficRule::speed, Trajectory(rows)).verdict, Verdict::clear);
}

TEST(RuleAudit, SeesSpeedsBehindAStandstill) {
  const Trajectory starts({{.t_s = 0.0, .x_m = 20, .y_m = -1.75},
                           {.t_s = 9.9, .x_m = 20.1, .y_m = -1.75},
                           {.t_s = 10.0, .x_m = 22, .y_m = -1.75}});
  const RuleReport report =
      audited(tests::straight_two_lane_road(100.0), TrafficRule::speed, starts);
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_EQ(report.violations.front().text, "68.4 km/h, limit 50.0 km/h");
}

TEST(RuleAudit, HoldsSpeedsAgainstTheLimitOfTheLane) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto at = [&](double speed_mps) {
    return audited(made, TrafficRule::speed, line(10, -1.75, 60, -1.75, speed_mps));
  };
  EXPECT_EQ(at(13.8).verdict, Verdict::clear);
  EXPECT_EQ(at(14.0).verdict, Verdict::conflict);
  made.lane(map::LaneId{0}).speed_limits = {{0.0, 20.0}, {30.0, 10.0}};
  const RuleReport report = at(15.0);
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_NEAR(report.violations.front().from_s, 20.0 / 15.0, 0.03);
  EXPECT_EQ(report.violations.front().text, "54.0 km/h, limit 36.0 km/h");
  made.lane(map::LaneId{0}).speed_limits.clear();
  EXPECT_EQ(at(15.0).verdict, Verdict::unknown);
  made.lane(map::LaneId{0}).speed_limits = {{0.0, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(at(80.0).verdict, Verdict::clear);
}

TEST(RuleAudit, HoldsSpeedsAgainstTheLimitOfAnOncomingLaneToo) {
  const tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const RuleReport report = audited(made, TrafficRule::speed, line(10, 1.75, 60, 1.75, 40.0));
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_EQ(report.violations.front().lane, "1/0/1");
  EXPECT_THAT(report.unknown, IsEmpty());
}

TEST(RuleAudit, SeesTheBodyOverSolidLinesOnly) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto over_middle = [&](MarkType type, double y_m) {
    for (std::uint32_t id : {0u, 1u})
      made.lane(map::LaneId{id}).left_marks = {{.type = type, .color = ""}};
    return audited(made, TrafficRule::markings, line(10, y_m, 60, y_m)).verdict;
  };
  const double touches_m = -kBody.left_m + 0.01, clear_m = -kBody.left_m - 0.01;
  EXPECT_EQ(over_middle(MarkType::solid, touches_m), Verdict::conflict);
  EXPECT_EQ(over_middle(MarkType::solid, clear_m), Verdict::clear);
  EXPECT_EQ(over_middle(MarkType::solid_solid, touches_m), Verdict::conflict);
  EXPECT_EQ(over_middle(MarkType::broken, touches_m), Verdict::clear);
  EXPECT_EQ(over_middle(MarkType::none, touches_m), Verdict::clear);
}

TEST(RuleAudit, KnowsFromWhichStationAMarkingIsSolid) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.lane(map::LaneId{0}).left = made.lane(map::LaneId{0}).left;
  made.lane(map::LaneId{0}).right_marks = {{0.0, MarkType::solid, "", 0.0}};
  const RuleReport report = audited(made, TrafficRule::markings, line(10, -2.0, 60, -3.4));
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_EQ(report.violations.front().text, "over the solid marking on its right");
}

/// Sections of 50 m of two lanes eastwards, left ones from y = 0 to -4, with one line between them.
tests::MadeMap lanes_beside(MarkType between) {
  tests::ShortSections road({50.0, 50.0});
  for (const map::LaneId id : road.left) road.made.lane(id).right_marks = {{0.0, between, "", 0.0}};
  for (const map::LaneId id : road.right) road.made.lane(id).left_marks = {{0.0, between, "", 0.0}};
  return road.made;
}

/// Lanes of Lanelet2 cross without a junction, each with its own lines.
TEST(RuleAudit, LooksNotAtLinesOfLanesThatCrossTheOneThatIsKept) {
  tests::MadeMap made;
  const map::LaneId east =
      made.add_lane(made.add_road("1"), "-1", {{0, 2}, {100, 2}}, {{0, -2}, {100, -2}});
  const map::LaneId north =
      made.add_lane(made.add_road("2"), "-1", {{48, -50}, {48, 50}}, {{52, -50}, {52, 50}});
  for (const map::LaneId id : {east, north}) {
    made.lane(id).left_marks = made.lane(id).right_marks = {{0.0, MarkType::solid, "", 0.0}};
  }
  EXPECT_THAT(audited(made, TrafficRule::markings, line(5, 0, 90, 0)).violations, IsEmpty());
  const RuleReport leaves = audited(made, TrafficRule::markings, line(5, 0, 90, 3));
  ASSERT_THAT(leaves.violations, testing::Not(IsEmpty()));
  EXPECT_EQ(leaves.violations.front().lane, made.lane(east).name);
}

TEST(RuleAudit, CountsACrossingAsOneViolationOnBothSidesOfTheLine) {
  const tests::MadeMap made = lanes_beside(MarkType::solid);
  for (const Trajectory& drive : {line(10, -2, 40, -6), line(35, -2, 65, -6), line(35, -6, 65, -2)})
    EXPECT_THAT(audited(made, TrafficRule::markings, drive).violations, SizeIs(1));
  const RuleReport report = audited(made, TrafficRule::markings, line(10, -2, 40, -6));
  // From when the front's right corner comes over the line until the rear's left one has left it.
  const double heading_rad = std::atan2(-4, 30), step_s = 0.2 / 10.0;
  const auto crossed_s = [&](double ahead_m, double left_m) {
    const double up_m = ahead_m * std::sin(heading_rad) + left_m * std::cos(heading_rad);
    return (2.0 + up_m) / -std::sin(heading_rad) / 10.0;  // the axle is then at y = -4 - up
  };
  EXPECT_NEAR(report.violations.front().from_s, crossed_s(kBody.front_m, kBody.right_m), step_s);
  EXPECT_NEAR(report.violations.front().to_s, crossed_s(kBody.rear_m, kBody.left_m), step_s);
  EXPECT_EQ(report.violations.front().lane, "0/0/-1");
}

TEST(RuleAudit, JudgesALineOfOneSideFromWhereItsCrossingBegan) {
  const auto sideways = [](double from_y_m, double to_y_m) {  // all of the body at once
    return Trajectory(
        {{.t_s = 0.0, .x_m = 10, .y_m = from_y_m}, {.t_s = 8.0, .x_m = 90, .y_m = to_y_m}});
  };
  for (const auto& [left, right] : {std::pair(line(10, -2, 40, -6), line(10, -6, 40, -2)),
                                    std::pair(line(35, -2, 65, -6), line(35, -6, 65, -2)),
                                    std::pair(sideways(-2, -6), sideways(-6, -2))}) {
    const auto verdict = [](MarkType type, const Trajectory& drive) {
      return audited(lanes_beside(type), TrafficRule::markings, drive).verdict;
    };
    EXPECT_EQ(verdict(MarkType::solid_broken, left), Verdict::conflict);
    EXPECT_EQ(verdict(MarkType::solid_broken, right), Verdict::clear);
    EXPECT_EQ(verdict(MarkType::broken_solid, left), Verdict::clear);
    EXPECT_EQ(verdict(MarkType::broken_solid, right), Verdict::conflict);
  }
}

TEST(RuleAudit, JudgesTheWayBackOverALineOfOneSideByItself) {
  const Trajectory there_and_back({{.t_s = 0.0, .x_m = 5, .y_m = -6},
                                   {.t_s = 4.0, .x_m = 45, .y_m = -2},
                                   {.t_s = 8.0, .x_m = 85, .y_m = -6}});
  const RuleReport report =
      audited(lanes_beside(MarkType::solid_broken), TrafficRule::markings, there_and_back);
  ASSERT_THAT(report.violations, SizeIs(1));
  EXPECT_GT(report.violations.front().from_s, 4.0);
}

TEST(RuleAudit, JudgesLinesBetweenOncomingLanesFromWhereTheirCrossingBegan) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto overtakes = [&](MarkType left_to_right) {  // each lane is to the left of the other
    made.lane(map::LaneId{0}).left_marks = {{0.0, left_to_right, "", 0.0}};
    const MarkType right_to_left =
        left_to_right == MarkType::solid_broken ? MarkType::broken_solid : MarkType::solid_broken;
    made.lane(map::LaneId{1}).left_marks = {{0.0, right_to_left, "", 0.0}};
    return audited(made, TrafficRule::markings, line(10, -1.75, 60, 1.75));
  };
  EXPECT_EQ(overtakes(MarkType::solid_broken).verdict, Verdict::clear);
  EXPECT_THAT(overtakes(MarkType::broken_solid).violations, SizeIs(1));
}

/// A light at station 50 of the eastward lane: green for 4 s, then red for 6 s.
struct LitRoad {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  std::vector<LightCycle> lights{{.signals = {"7"},
                                  .pointer = {},
                                  .phases = {{LightColour::green, 4.0}, {LightColour::red, 6.0}}}};

  LitRoad() {
    map::Signal light;
    light.source_id = "7";
    light.in_map = {50.0, -4.0};
    light.dynamic = true;
    light.lanes = {map::LaneId{0}};
    light.lane_s_m = {50.0};
    made.parts.signals.push_back(std::move(light));
  }

  RuleReport passed_at(double t_s, bool is_known = true) const {
    const double speed_mps = 5.0, from_x = 50.0 - kBody.front_m - speed_mps * t_s;
    Trajectory drive = line(from_x, -1.75, from_x + 8.0 * speed_mps, -1.75, speed_mps);
    return audited(made, TrafficRule::lights, drive,
                   is_known ? std::span<const LightCycle>(lights) : std::span<const LightCycle>());
  }
};

TEST(RuleAudit, SeesTheFrontPassARedLight) {
  const LitRoad road;
  EXPECT_EQ(road.passed_at(3.5).verdict, Verdict::clear);
  const RuleReport red = road.passed_at(4.5);
  ASSERT_EQ(red.verdict, Verdict::conflict);
  EXPECT_NEAR(red.violations.front().from_s, 4.5, 0.05);
  EXPECT_EQ(road.passed_at(4.5, false).verdict, Verdict::unknown);
}

TEST(RuleAudit, LooksAtLightsOfOtherLanesNot) {
  const LitRoad road;
  EXPECT_EQ(
      audited(road.made, TrafficRule::lights, line(80, 1.75, 20, 1.75, 5.0), road.lights).verdict,
      Verdict::clear);
}

}  // namespace
}  // namespace roadbed::planning
