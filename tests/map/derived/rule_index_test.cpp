#include "roadbed/map/derived/rule_index.h"

#include <gtest/gtest.h>

#include <array>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

Signal signal_at(const Eigen::Vector2d& place, std::vector<LaneId> lanes) {
  Signal signal;
  signal.in_map = place;
  signal.lanes = std::move(lanes);
  return signal;
}

/// Three lanes of 50 m in a row; a light at 30 m of the first and one beyond the end of the last, a
/// stop line across the second at 40 m.
tests::MadeMap row_with_rules() {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.parts.signals = {signal_at({160.0, 4.0}, {LaneId{2}}), signal_at({30.0, -4.0}, {LaneId{0}})};
  StopLine stop_line;
  stop_line.in_map = {{90.0, -2.0, 0.0}, {90.0, 2.0, 0.0}};
  stop_line.lanes = {LaneId{1}};
  made.parts.stop_lines = {stop_line};
  Regulation regulation;
  regulation.type = "right_of_way";
  regulation.lanes = {LaneId{1}, LaneId{2}};
  made.parts.regulations = {regulation};
  return made;
}

TEST(RuleIndex, GivesRulesAheadByTheWayToThem) {
  const RoadMap road_map = row_with_rules().build();
  const RuleIndex rules(road_map);
  const std::array<LaneId, 3> path{LaneId{0}, LaneId{1}, LaneId{2}};
  const auto ahead = rules.ahead(path, 10.0, 200.0);
  ASSERT_EQ(ahead.size(), 3u);
  EXPECT_EQ(ahead[0].index, 1u);
  EXPECT_NEAR(ahead[0].distance_m, 20.0, 1e-9);
  EXPECT_EQ(ahead[1].kind, RuleKind::stop_line);
  EXPECT_NEAR(ahead[1].s_m, 40.0, 1e-9);
  EXPECT_NEAR(ahead[1].distance_m, 80.0, 1e-9);
  EXPECT_EQ(ahead[2].index, 0u);
  EXPECT_NEAR(ahead[2].distance_m, 140.0, 1e-9);  // it stands beyond the end
}

TEST(RuleIndex, LeavesOutWhatIsBehindAndTooFar) {
  const RoadMap road_map = row_with_rules().build();
  const RuleIndex rules(road_map);
  const std::array<LaneId, 3> path{LaneId{0}, LaneId{1}, LaneId{2}};
  const auto ahead = rules.ahead(path, 30.5, 60.0);
  ASSERT_EQ(ahead.size(), 1u);
  EXPECT_EQ(ahead[0].kind, RuleKind::stop_line);
}

TEST(RuleIndex, SaysWhatHoldsAtAStation) {
  tests::MadeMap made = row_with_rules();
  made.lane(LaneId{1}).speed_limits = {{0.0, 13.9}, {20.0, 8.3}};
  const RoadMap road_map = made.build();
  const RuleIndex rules(road_map);
  EXPECT_EQ(rules.at(LaneId{1}, 19.9).speed_limit_mps, 13.9);
  const RulesAt at = rules.at(LaneId{1}, 20.0);
  EXPECT_EQ(at.speed_limit_mps, 8.3);
  EXPECT_EQ(at.regulations, std::vector<std::size_t>{0});
  EXPECT_FALSE(at.next_signal.has_value());
  ASSERT_TRUE(at.next_stop_line.has_value());
  EXPECT_NEAR(at.next_stop_line->distance_m, 20.0, 1e-9);
  EXPECT_FALSE(rules.at(LaneId{1}, 40.1).next_stop_line.has_value());
  EXPECT_TRUE(rules.at(LaneId{0}, 0.0).regulations.empty());
}

TEST(RuleIndex, OfSomeLanesSaysOfThemWhatThatOfAllSays) {
  const RoadMap road_map = row_with_rules().build();
  const std::array<LaneId, 2> wanted{LaneId{0}, LaneId{1}};
  const RuleIndex all(road_map), some(road_map, wanted);
  const auto expected = all.ahead(wanted, 10.0, 200.0), found = some.ahead(wanted, 10.0, 200.0);
  ASSERT_EQ(expected.size(), 2U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].kind, expected[i].kind);
    EXPECT_EQ(found[i].index, expected[i].index);
    EXPECT_EQ(found[i].s_m, expected[i].s_m);
  }
  EXPECT_EQ(some.at(LaneId{1}, 0.0).regulations, all.at(LaneId{1}, 0.0).regulations);
  EXPECT_FALSE(all.at(LaneId{2}, 0.0).regulations.empty());
  EXPECT_TRUE(some.at(LaneId{2}, 0.0).regulations.empty());
}

TEST(RuleIndex, LetsLanesChangeOnlyWithinTheirWindows) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId left = made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId right = made.add_lane(road, "-2", {{0, 0}, {50, 0}}, {{0, -3}, {50, -3}});
  made.put_beside(left, right);
  made.parts.links[left.index].right->change_windows = {{10.0, 20.0}};
  const RoadMap road_map = made.build();
  const RuleIndex rules(road_map);
  EXPECT_FALSE(rules.at(left, 9.0).may_change_right);
  EXPECT_TRUE(rules.at(left, 15.0).may_change_right);
  EXPECT_FALSE(rules.at(left, 15.0).may_change_left);
  EXPECT_TRUE(rules.at(right, 40.0).may_change_left);
}

}  // namespace
}  // namespace roadbed::map
