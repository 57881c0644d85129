#include "roadbed/planning/speed/goals_on_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tools {
namespace {

/// A straight path that begins at (0, y), sampled every metre.
planning::PathProfile path_from(double y_m, double heading_rad) {
  planning::PathProfile path;
  const Eigen::Vector2d along(std::cos(heading_rad), std::sin(heading_rad));
  for (int i = 0; i <= 80; ++i) {
    const Eigen::Vector2d at = Eigen::Vector2d(0.0, y_m) + i * along;
    path.ahead_m.push_back(i);
    path.station_m.push_back(100.0 + i);
    path.body.push_back(geometry::body_at({at.x(), at.y(), heading_rad}, {}));
  }
  return path;
}

/// The centre within 1 m to both sides of (40, 1) in y, 5 m in x, the heading within 0.1 rad.
planning::TimedGoal goal() {
  return {.step_s = 0.2,
          .states = {{.time_s = {4.0, 6.0},
                      .speed_mps = {5.0, 8.0},
                      .heading_rad = planning::Window{-0.1, 0.1},
                      .region_in_source = {map::commonroad::RectangleShape{
                          .length_m = 10.0, .width_m = 2.0, .centre_m = {40.0, 1.0}}},
                      .lanes = {}}}};
}

std::vector<planning::GoalAhead> met_on(const planning::PathProfile& path, double now_s = 0.0) {
  tests::MadeMap made;
  made.parts.format = "made";
  made.add_lane(made.add_road("1"), "-1", {{0, 9}, {100, 9}}, {{0, -9}, {100, -9}});
  return goals_on_path(goal(), made.build(), path, now_s);
}

/// Of a path that passes the goal at 3 m to the side, on a line that meets it at some stations.
planning::PathGoals with_stretch(double from_s_m) {
  tests::MadeMap made;
  made.parts.format = "made";
  made.add_lane(made.add_road("1"), "-1", {{0, 9}, {100, 9}}, {{0, -9}, {100, -9}});
  const planning::GoalStretch stretch{
      .time_s = {4.0, 6.0}, .speed_mps = {}, .s_m = {from_s_m, from_s_m + 9.0}};
  return path_goals(goal(), made.build(), {stretch}, path_from(-3.0, 0.0), 0.0);
}

constexpr double kCentreAhead_m = 0.5 * 4.508 - 0.8312829;

TEST(GoalsOnPath, CentreIsInTheRegionByTheMarginAndTheRestIsFromNow) {
  const auto met = met_on(path_from(1.0, 0.0), 1.0);
  ASSERT_EQ(met.size(), 1u);
  EXPECT_NEAR(met[0].ahead_m.least, 35.0 - kCentreAhead_m + 0.3, 0.02);
  EXPECT_NEAR(met[0].ahead_m.most, 45.0 - kCentreAhead_m - 0.3, 0.02);
  EXPECT_NEAR(met[0].time_s.least, 3.0, 1e-12);
  EXPECT_NEAR(met[0].time_s.most, 5.0, 1e-12);
  EXPECT_NEAR(met[0].speed_mps.least, 5.2, 1e-12);
  EXPECT_NEAR(met[0].speed_mps.most, 7.8, 1e-12);
  EXPECT_NEAR(met[0].step_s, 0.2, 1e-12);
  EXPECT_NEAR(met[0].a_step_s, -1.0, 1e-12);
}

TEST(GoalsOnPath, OffsetOfThePathCountsNotThatOfAnyLine) {
  EXPECT_EQ(met_on(path_from(1.7, 0.0)).size(), 1u);
  EXPECT_EQ(met_on(path_from(0.3, 0.0)).size(), 1u);
  EXPECT_TRUE(met_on(path_from(2.1, 0.0)).empty());
  EXPECT_TRUE(met_on(path_from(-0.1, 0.0)).empty());
}

TEST(GoalsOnPath, HeadingOfThePathCounts) {
  // So that the middle of the region is crossed.
  const auto through = [](double heading_rad) {
    return path_from(1.0 - 40.0 * std::tan(heading_rad), heading_rad);
  };
  EXPECT_EQ(met_on(through(0.04)).size(), 1u);
  EXPECT_EQ(met_on(through(-0.04)).size(), 1u);
  EXPECT_TRUE(met_on(through(0.11)).empty());
  EXPECT_TRUE(met_on(through(-0.11)).empty());
}

TEST(GoalsOnPath, EdgeOfAWindowIsTakenWhereThereIsNothingInside) {
  EXPECT_EQ(met_on(path_from(1.9, 0.0)).size(), 1u);
  // Crosses the region from corner to corner at 0.09 rad: without a margin longer.
  const double turned_rad = 0.09;
  const auto met = met_on(path_from(1.0 - 40.0 * std::tan(turned_rad), turned_rad));
  ASSERT_EQ(met.size(), 1u);
  const double from_m = 35.0 / std::cos(turned_rad) - kCentreAhead_m;
  EXPECT_NEAR(met[0].ahead_m.least, from_m + 0.3, 0.02);
}

TEST(GoalsOnPath, OneThatOnlyTheLineMeetsIsMissedUnlessALaterPathMayLeadThere) {
  const auto near = with_stretch(158.0), far = with_stretch(162.0);
  EXPECT_TRUE(near.is_off_path);
  EXPECT_FALSE(far.is_off_path);
  ASSERT_EQ(near.goals.size(), 1u);  // it is aimed at all the same
  ASSERT_EQ(far.goals.size(), 1u);
  EXPECT_NEAR(near.goals[0].ahead_m.least, 58.3, 1e-9);
  EXPECT_NEAR(far.goals[0].ahead_m.most, 70.7, 1e-9);
}

}  // namespace
}  // namespace roadbed::tools
