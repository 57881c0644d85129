#include "roadbed/planning/rules/speed_limit.h"

#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

TEST(SpeedLimit, IsThatOfTheLaneThatIsDrivenAlong) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.lane(map::LaneId{0}).speed_limits = {{0.0, 10.0}, {50.0, 20.0}};
  made.lane(map::LaneId{1}).speed_limits.clear();
  const map::RoadMap road_map = made.build();
  const double against_rad = std::numbers::pi;
  const auto limits = limits_along(
      road_map,
      geometry::Trajectory({{.t_s = 0, .x_m = 20, .y_m = -1.75},
                            {.t_s = 1, .x_m = 70, .y_m = -1.75},
                            {.t_s = 2, .x_m = 70, .y_m = -1.75, .heading_rad = against_rad},
                            {.t_s = 3, .x_m = 70, .y_m = -30},
                            {.t_s = 4, .x_m = 70, .y_m = 1.75, .heading_rad = against_rad}}));
  ASSERT_EQ(limits.size(), 5u);
  EXPECT_EQ(limits[0]->limit_mps, 10.0);
  EXPECT_EQ(limits[1]->limit_mps, 20.0);
  EXPECT_EQ(limits[1]->lane, &road_map.lane(map::LaneId{0}));
  EXPECT_EQ(limits[2]->limit_mps, 20.0) << "against the only lane";
  EXPECT_FALSE(limits[3]) << "off the road";
  EXPECT_FALSE(limits[4]) << "the lane says nothing";
}

}  // namespace
}  // namespace roadbed::planning
