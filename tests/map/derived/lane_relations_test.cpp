#include "roadbed/map/derived/lane_relations.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

TEST(OppositeLane, IsAcrossTheMiddleOfTheRoad) {
  tests::MadeMap made = tests::straight_two_lane_road(50.0);
  const LaneId outer = made.add_lane(RoadId{0}, "-2", {{0, -3.5}, {50, -3.5}}, {{0, -7}, {50, -7}});
  made.put_beside(LaneId{0}, outer);
  const RoadMap road_map = made.build();
  const auto opposite = opposite_lanes(road_map.graph());
  EXPECT_EQ(opposite[0], LaneId{1});
  EXPECT_EQ(opposite[1], LaneId{0});
  EXPECT_EQ(opposite[outer.index], LaneId{1});
}

TEST(OppositeLane, IsMissingOnAOneWayRoad) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  EXPECT_FALSE(opposite_lanes(road_map.graph())[0].has_value());
}

TEST(OppositeLane, ComesToAnEndWhereNeighboursFormACircle) {
  const LaneGraph graph(
      {{{}, {}, Neighbour{LaneId{1}, true, {}}, {}}, {{}, {}, Neighbour{LaneId{0}, true, {}}, {}}});
  EXPECT_FALSE(opposite_lanes(graph)[0].has_value());
}

TEST(OppositeLane, IsThatOfEveryLaneOnTheWayThere) {
  constexpr std::uint32_t kLanes = 50;  // the last one runs against the others
  std::vector<LaneLinks> links(kLanes);
  for (std::uint32_t i = 0; i + 1 < kLanes; ++i) {
    links[i].left = Neighbour{LaneId{i + 1}, i + 2 < kLanes, {}};
  }
  links[kLanes - 1].left = Neighbour{LaneId{kLanes - 2}, false, {}};
  const auto opposite = opposite_lanes(LaneGraph(links));
  for (std::uint32_t i = 0; i + 1 < kLanes; ++i) EXPECT_EQ(opposite[i], LaneId{kLanes - 1}) << i;
  EXPECT_EQ(opposite[kLanes - 1], LaneId{kLanes - 2});
}

TEST(DrivesOnTheLeft, IsAsTheRoadsSayWithoutOncomingLanesBesideThem) {
  for (const bool on_left_side : {false, true}) {
    for (const bool left_hand : {false, true}) {
      tests::MadeRoad road;
      road.attributes = left_hand ? R"(rule="LHT")" : "";
      const std::string lanes = on_left_side ? tests::made_lane(2) + tests::made_lane(1)
                                             : tests::made_lane(-1) + tests::made_lane(-2);
      road.lanes = tests::made_section(0.0, on_left_side ? lanes : "", on_left_side ? "" : lanes);
      EXPECT_EQ(drives_on_the_left(tests::made_map(tests::made_road(road))), left_hand);
    }
  }
}

TEST(Merges, AreWhereLanesShareASuccessor) {
  const LaneGraph graph({{{LaneId{2}}, {}, {}, {}},
                         {{LaneId{2}}, {}, {}, {}},
                         {{LaneId{3}}, {LaneId{1}, LaneId{0}}, {}, {}},
                         {{}, {LaneId{2}}, {}, {}}});
  const auto found = merges(graph);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].into, LaneId{2});
  EXPECT_EQ(found[0].from, (std::vector<LaneId>{LaneId{0}, LaneId{1}}));
  EXPECT_EQ(merging_lanes(graph, LaneId{0}), std::vector<LaneId>{LaneId{1}});
  EXPECT_TRUE(merging_lanes(graph, LaneId{2}).empty());
}

}  // namespace
}  // namespace roadbed::map
