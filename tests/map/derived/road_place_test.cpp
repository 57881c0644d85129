#include "roadbed/map/derived/lane_frame.h"

#include <gtest/gtest.h>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

TEST(RoadPlace, IsMeasuredFromTheRoadsReferenceLineWithinTheLanesRange) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  Road& road = made.parts.roads[0];
  road.reference_in_map = geometry::Polyline({{0, 0}, {40, 0}, {100, 0}});
  road.reference_road_s_m = {0, 40, 100};
  made.parts.lanes[1].origin.road_from_s_m = 100.0;  // against the road
  made.parts.lanes[1].origin.road_to_s_m = 0.0;
  const RoadMap road_map = made.build();
  for (const LaneId lane : {LaneId{0}, LaneId{1}}) {
    const auto place = road_place(road_map, lane, {70.0, 2.5});
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->s_m, 70.0, 1e-12);
    EXPECT_NEAR(place->t_m, 2.5, 1e-12);
  }
  made.parts.lanes[0].origin.road_to_s_m = 50.0;
  EXPECT_NEAR(road_place(made.build(), {0}, {70.0, -1.0})->s_m, 50.0, 1e-12);
  made.parts.lanes[0].road = std::nullopt;
  made.parts.roads[0].lanes.clear();
  EXPECT_FALSE(road_place(made.build(), {0}, {70.0, -1.0}));
}

}  // namespace
}  // namespace roadbed::map
