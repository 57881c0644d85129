#include "roadbed/map/derived/components.h"

#include <gtest/gtest.h>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

using Groups = std::vector<std::vector<LaneId>>;

TEST(DrivableComponents, PutsTheLargestGroupFirst) {
  tests::MadeMap made = tests::straight_two_lane_road();  // lanes 0 and 1, opposite: two groups
  const RoadId road = made.add_road("2");
  const LaneId a = made.add_lane(road, "-1", {{0, 20}, {9, 20}}, {{0, 17}, {9, 17}});
  const LaneId b = made.add_lane(road, "-2", {{9, 20}, {19, 20}}, {{9, 17}, {19, 17}});
  made.link(a, b);
  EXPECT_EQ(drivable_components(made.build()),
            (Groups{{LaneId{2}, LaneId{3}}, {LaneId{0}}, {LaneId{1}}}));
}

TEST(DrivableComponents, JoinsAcrossLaneChangesThatAreAllowedOnly) {
  for (const bool allowed : {true, false}) {
    tests::MadeMap made;
    const RoadId road = made.add_road("1");
    const LaneId left = made.add_lane(road, "-1", {{0, 3}, {9, 3}}, {{0, 0}, {9, 0}});
    const LaneId right = made.add_lane(road, "-2", {{0, 0}, {9, 0}}, {{0, -3}, {9, -3}});
    made.put_beside(left, right, allowed);
    EXPECT_EQ(drivable_components(made.build()).size(), allowed ? 1u : 2u);
  }
}

TEST(DrivableComponents, LeaveSidewalksOut) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane(LaneId{1}).type = LaneType::sidewalk;
  EXPECT_EQ(drivable_components(made.build()), (Groups{{LaneId{0}}, {LaneId{2}}}));
}

}  // namespace
}  // namespace roadbed::map
