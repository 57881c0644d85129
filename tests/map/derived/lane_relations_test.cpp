#include "roadbed/map/derived/lane_relations.h"

#include <gtest/gtest.h>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

TEST(OppositeLane, IsAcrossTheMiddleOfTheRoad) {
  tests::MadeMap made = tests::straight_two_lane_road(50.0);
  const LaneId outer = made.add_lane(RoadId{0}, "-2", {{0, -3.5}, {50, -3.5}}, {{0, -7}, {50, -7}});
  made.put_beside(LaneId{0}, outer);
  const RoadMap road_map = made.build();
  EXPECT_EQ(opposite_lane(road_map.graph(), LaneId{0}), LaneId{1});
  EXPECT_EQ(opposite_lane(road_map.graph(), LaneId{1}), LaneId{0});
  EXPECT_EQ(opposite_lane(road_map.graph(), outer), LaneId{1});
}

TEST(OppositeLane, IsMissingOnAOneWayRoad) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  EXPECT_FALSE(opposite_lane(road_map.graph(), LaneId{0}).has_value());
}

TEST(OppositeLane, ComesToAnEndWhereNeighboursFormACircle) {
  const LaneGraph graph(
      {{{}, {}, Neighbour{LaneId{1}, true, {}}, {}}, {{}, {}, Neighbour{LaneId{0}, true, {}}, {}}});
  EXPECT_FALSE(opposite_lane(graph, LaneId{0}).has_value());
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
