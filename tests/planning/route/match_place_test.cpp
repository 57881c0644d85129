#include "roadbed/planning/route/match_place.h"

#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

// Lane 1/0/-1 eastwards below the x axis, 1/0/1 westwards above it, 3.5 m wide.
const map::RoadMap& two_lanes() {
  static const map::RoadMap road_map = tests::straight_two_lane_road().build();
  return road_map;
}

TEST(MatchPlace, TakesTheLaneThatThePointIsOnAndListsTheOther) {
  const auto found = match_place(two_lanes(), {30.0, -0.2}, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].place.lane, map::LaneId{0});
  EXPECT_EQ(found[0].verdict, MatchVerdict::chosen);
  EXPECT_NEAR(found[0].place.s_m, 30.0, 1e-9);
  EXPECT_NEAR(found[0].place.d_m, 1.55, 1e-9);
  EXPECT_EQ(found[0].distance_m, 0.0);
  EXPECT_EQ(found[1].verdict, MatchVerdict::possible);
  EXPECT_NEAR(found[1].distance_m, 0.2, 1e-9);
  EXPECT_NEAR(found[1].misfit_m, 0.2 + 0.1 * 1.95, 1e-9);
}

TEST(MatchPlace, AHeadingBeatsAFewDecimetres) {
  const auto found = match_place(two_lanes(), {30.0, -0.2}, std::numbers::pi);
  EXPECT_EQ(found[0].place.lane, map::LaneId{1});
  EXPECT_EQ(found[0].verdict, MatchVerdict::chosen);
  EXPECT_EQ(found[1].verdict, MatchVerdict::against_heading);
}

TEST(MatchPlace, AgainstTheOnlyLaneThereItIsStillThatLane) {
  const auto found = match_place(two_lanes(), {30.0, -2.0}, std::numbers::pi);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, MatchVerdict::chosen);
}

TEST(MatchPlace, OffTheRoadNamesTheNearestLanes) {
  const auto found = match_place(two_lanes(), {30.0, -13.5}, {});
  ASSERT_GE(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, MatchVerdict::too_far);
  EXPECT_EQ(found[0].place.lane, map::LaneId{0});
  EXPECT_NEAR(found[0].distance_m, 10.0, 1e-9);
}

TEST(MatchPlace, LanesOfOthersAreNamedButNotChosen) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.lane({0}).participants = {map::Participant::bicycle};
  const map::RoadMap road_map = made.build();
  const auto by_car = match_place(road_map, {30.0, -3.0}, {});
  EXPECT_EQ(by_car.front().verdict, MatchVerdict::too_far);
  EXPECT_EQ(by_car.front().place.lane, map::LaneId{1});
  EXPECT_EQ(by_car.back().verdict, MatchVerdict::not_for_participant);
  const auto by_bicycle =
      match_place(road_map, {30.0, -3.0}, {}, {.participant = map::Participant::bicycle});
  EXPECT_EQ(by_bicycle.front().verdict, MatchVerdict::chosen);
  EXPECT_EQ(by_bicycle.front().place.lane, map::LaneId{0});
}

}  // namespace
}  // namespace roadbed::planning
