#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/report/surroundings.h"

#include <gtest/gtest.h>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tools {
namespace {

const map::RoadMap& town() {
  static const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  return road_map;
}

planning::Route route_through_town() {
  const auto from = town().find_lane("1/3/1"), to = town().find_lane("7/0/1");
  const auto answer = planning::find_route(town(), {*from, 6.0, 0.0}, {*to, 55.0, 0.0});
  EXPECT_TRUE(answer.route) << answer.reason;
  return *answer.route;
}

TEST(MapAround, IsTheMapNearABoxInSourceCoordinates) {
  const map::Lane& lane = town().lane(*town().find_lane("7/0/1"));
  const Eigen::Vector2d inside = town().to_source(lane.pose_at(30.0).position());
  const auto near = map_around(town(), {inside, inside});
  EXPECT_TRUE(near->find_lane("7/0/1"));
  EXPECT_LT(near->lanes().size(), 12U);
  EXPECT_EQ(map_around(town(), {})->lanes().size(), 0U);
}

TEST(RouteLines, LeadFromStartToGoalWithoutAJump) {
  const planning::Route route = route_through_town();
  const auto lines = route_lines(town(), route);
  ASSERT_EQ(lines.size(), route.legs.size());
  double length_m = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    length_m += geometry::Polyline(lines[i]).length_m();
    const auto exit = i == 0 ? planning::LegExit::goal : route.legs[i - 1].exit;
    if (exit == planning::LegExit::successor) {
      EXPECT_LT((lines[i].front() - lines[i - 1].back()).norm(), 0.05);
    }
  }
  EXPECT_GT(length_m, 500.0);
  EXPECT_NEAR((lines.back().back() - *route_goal(town(), route)).norm(), 0.0, 1e-9);
}

TEST(RouteGoal, OfNoRouteIsNone) { EXPECT_FALSE(route_goal(town(), {})); }

TEST(ReferencePoints, AreOnTheReferenceLineAMetreApart) {
  const auto line = planning::ReferenceLine::along(town(), route_through_town());
  const LineInSource points = reference_points(town(), line);
  EXPECT_NEAR((points.front() - town().to_source(line.at(0.0).in_map)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((points.back() - town().to_source(line.at(line.length_m()).in_map)).norm(), 0.0,
              1e-9);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_LT((points[i] - points[i - 1]).norm(), 1.0 + 1e-9);
  }
}

TEST(ObstacleInSource, MovesItsPlaceAndKeepsTheRest) {
  planning::Obstacle obstacle{
      .id = "a",
      .kind = "truck",
      .length_m = 9.0,
      .width_m = 2.5,
      .motion = geometry::Trajectory(
          {{.t_s = 1.0, .x_m = 3.0, .y_m = 4.0, .heading_rad = 0.7, .speed_mps = 2.0}})};
  const planning::ObstacleInSource moved = planning::obstacle_in_source(town(), obstacle);
  const auto point = moved.motion.points().front();
  EXPECT_NEAR((point.pose().position() - town().origin_in_source() - Eigen::Vector2d(3, 4)).norm(),
              0.0, 1e-9);
  EXPECT_EQ(point.heading_rad, 0.7);
  EXPECT_EQ(point.t_s, 1.0);
  EXPECT_EQ(moved.kind, "truck");
}

}  // namespace
}  // namespace roadbed::tools
