#include "roadbed/planning/speed/timed_goal.h"

#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tools {
namespace {

using map::commonroad::CircleShape;
using map::commonroad::PolygonShape;
using map::commonroad::RectangleShape;
using map::commonroad::Shape;

map::RoadMap straight_road() {
  tests::MadeMap made;
  made.parts.format = "made";
  made.add_lane(made.add_road("1"), "-1", {{0, 2}, {100, 2}}, {{0, -2}, {100, -2}});
  return made.build();
}

/// The rear axle of a vehicle whose centre is at a point.
geometry::Pose2 centred_at(double x_m, double y_m, double heading_rad) {
  const geometry::VehicleShape vehicle;
  return geometry::Pose2{x_m, y_m, heading_rad} *
         geometry::Pose2{vehicle.rear_overhang_m - 0.5 * vehicle.length_m, 0.0, 0.0};
}

TEST(TimedGoal, ShapesContainWhatLiesInThem) {
  const Shape turned{RectangleShape{.length_m = 4.0,
                                    .width_m = 2.0,
                                    .heading_rad = 0.5 * std::numbers::pi,
                                    .centre_m = {10.0, 0.0}}};
  EXPECT_TRUE(planning::contains(turned, {10.9, 1.9}));
  EXPECT_FALSE(planning::contains(turned, {11.1, 0.0}));
  const Shape round{CircleShape{.radius_m = 2.0, .centre_m = {0.0, 0.0}}};
  EXPECT_TRUE(planning::contains(round, {1.4, 1.4}));
  EXPECT_FALSE(planning::contains(round, {1.5, 1.5}));
  const Shape corner{PolygonShape{{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}}};
  EXPECT_TRUE(planning::contains(corner, {0.5, 3.5}));
  EXPECT_FALSE(planning::contains(corner, {2.0, 2.0}));
}

TEST(TimedGoal, EverythingHasToHoldAtTheSameTime) {
  const map::RoadMap road_map = straight_road();
  const planning::TimedGoal goal{
      .step_s = 0.1,
      .states = {{.time_s = {2.0, 3.0},
                  .speed_mps = {5.0, 8.0},
                  .heading_rad = planning::Window{-0.1, 0.1},
                  .region_in_source = {RectangleShape{
                      .length_m = 4.0, .width_m = 2.0, .centre_m = {50.0, 0.0}}},
                  .lanes = {}}}};
  const auto reached = [&](double x_m, double heading_rad, double speed_mps, double t_s) {
    return goal.is_reached(road_map, centred_at(x_m, 0.0, heading_rad), speed_mps, t_s, {});
  };
  EXPECT_TRUE(reached(51.0, 0.0, 6.0, 2.5));
  EXPECT_TRUE(reached(51.0, 2.0 * std::numbers::pi, 6.0, 2.5));
  EXPECT_FALSE(reached(53.0, 0.0, 6.0, 2.5));
  EXPECT_FALSE(reached(51.0, 0.2, 6.0, 2.5));
  EXPECT_FALSE(reached(51.0, 0.0, 9.0, 2.5));
  EXPECT_FALSE(reached(51.0, 0.0, 6.0, 3.1));
}

TEST(TimedGoal, NoStateIsNeverReached) {
  const planning::TimedGoal none;
  EXPECT_FALSE(none.is_reached(straight_road(), {}, 0.0, 0.0, {}));
  EXPECT_FALSE(none.latest_s());
}

TEST(TimedGoal, StretchHoldsTheRearAxleWhileTheCentreIsInTheRegion) {
  const map::RoadMap road_map = straight_road();
  const auto line = planning::ReferenceLine::through({{0, 0}, {100, 0}}, 2.0, 10.0);
  const planning::TimedGoal goal{
      .step_s = 0.1,
      .states = {{.time_s = {0.0, 9.0},
                  .speed_mps = {},
                  .heading_rad = {},
                  .region_in_source = {RectangleShape{
                      .length_m = 10.0, .width_m = 3.0, .centre_m = {40.0, 0.0}}},
                  .lanes = {}}}};
  const auto stretches = goal_stretches(goal, road_map, line, {});
  ASSERT_EQ(stretches.size(), 1u);
  const double ahead_m = 0.5 * geometry::VehicleShape{}.length_m - 0.8312829;
  EXPECT_NEAR(stretches[0].s_m.least, 35.0 - ahead_m, 0.11);
  EXPECT_NEAR(stretches[0].s_m.most, 45.0 - ahead_m, 0.11);
}

}  // namespace
}  // namespace roadbed::tools
