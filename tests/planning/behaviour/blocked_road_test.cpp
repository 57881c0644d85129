#include "roadbed/planning/behaviour/blocked_road.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

/// A car on the straight road that stands, but drives on a little from a time on, for 2 s.
planning::Obstacle car_at(const std::string& id, double x_m, double moves_at_s = 1e6) {
  return {.id = id,
          .motion = drive_through({{0.0, {x_m, 0.0, 0.0}},
                                   {moves_at_s, {x_m, 0.0, 0.0}},
                                   {moves_at_s + 2.0, {x_m + 2.0, 0.0, 0.0}}})};
}

/// The vehicle stands behind the first obstacle, with 5 m between them.
class BehindSomebody : public testing::Test {
 protected:
  void stand_behind(std::vector<planning::Obstacle> obstacles) {
    const double rear_m = obstacles.front().motion.at(0.0).x_m - 2.25;
    world_ = std::make_unique<World>(tests::straight_world({}, std::move(obstacles)));
    measured_.map_from_vehicle = {rear_m - 5.0 - scenario_.vehicle.front_m(), 0.0, 0.0};
    road_.emplace(scenario_.vehicle, scenario_.options, *world_);
  }

  void place(planning::StopKind kind, double x_m) {
    world_->stop_points = {{.kind = kind, .s_m = x_m - 10.0, .clear_s_m = x_m, .name = "place 1"}};
    if (kind != planning::StopKind::light) return;
    world_->stop_points.front().light = 0;
    world_->lights = {
        {.signals = {"1"},
         .pointer = "",
         .phases = {{planning::LightColour::red, 30.0}, {planning::LightColour::green, 300.0}}}};
  }

  std::optional<planning::BlockedRoad::Decision> look(double t_s, bool waits_for_rule = false) {
    return road_->look({.t_s = t_s,
                        .measured = measured_,
                        .traffic = {world_->obstacles},
                        .ahead = 0,
                        .waits_for_rule = waits_for_rule});
  }

  /// When it is first said to be blocked, looked at every 0.1 s; none within 100 s.
  std::optional<double> blocked_at_s() {
    for (int k = 0; k < 1000; ++k) {
      if (look(0.1 * k)) return 0.1 * k;
    }
    return std::nullopt;
  }

  Scenario scenario_;
  std::unique_ptr<World> world_;
  planning::VehicleState measured_;
  std::optional<planning::BlockedRoad> road_;
};

TEST_F(BehindSomebody, WhoStandsForTenSecondsBlocksTheRoadAndIsAskedForOnce) {
  stand_behind({car_at("first", 60.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 10.0, 0.051);
  const auto later = look(20.0);
  ASSERT_TRUE(later);
  EXPECT_FALSE(later->is_news);
  EXPECT_FALSE(later->detour);
  EXPECT_THAT(later->reason, HasSubstr("the road is blocked: car first has not moved for 10 s; no "
                                       "other route: no lane sequence leads from lane"));
  EXPECT_THAT(later->reason, HasSubstr("between them stand closed lanes"));
}

TEST_F(BehindSomebody, WhoMovesBeginsTheWaitAnew) {
  stand_behind({car_at("first", 60.0, 7.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 19.0, 0.151);
  stand_behind({car_at("first", 60.0), car_at("second", 70.0, 7.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 17.0, 0.151) << "a queue that moves";
  stand_behind({car_at("first", 60.0), car_at("second", 70.0), car_at("third", 85.0, 8.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 68.0, 0.151) << "its head moves";
  stand_behind({car_at("first", 60.0), car_at("far", 90.0, 7.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 10.0, 0.051) << "not of the same queue";
}

TEST_F(BehindSomebody, AQueueAtARedLightIsNoBlockedRoad) {
  stand_behind({car_at("first", 60.0), car_at("second", 70.0)});
  place(planning::StopKind::light, 72.25 + 29.0);
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 40.0, 0.151) << "10 s after it was green";
  stand_behind({car_at("first", 60.0), car_at("second", 70.0)});
  place(planning::StopKind::light, 72.25 + 31.0);
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 10.0, 0.051) << "too far from the light";
}

TEST_F(BehindSomebody, WhoMayWaitAtASignIsGivenAMinute) {
  stand_behind({car_at("first", 60.0)});
  place(planning::StopKind::give_way, 62.25 + 2.0);
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 60.0, 0.051);
}

TEST_F(BehindSomebody, AJamIsGivenAMinuteAndNotPassedLikeParkedCars) {
  stand_behind({car_at("first", 60.0), car_at("second", 70.0)});
  ASSERT_NEAR(blocked_at_s().value_or(1e9), 10.0, 0.051);
  EXPECT_EQ(look(20.0)->blockers.size(), 2U);
  stand_behind({car_at("first", 60.0), car_at("second", 70.0), car_at("third", 85.0)});
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 60.0, 0.051);
  EXPECT_THAT(look(70.0)->blockers, testing::IsEmpty());
}

TEST_F(BehindSomebody, BarriersOneBehindTheOtherAreNoJam) {
  std::vector<planning::Obstacle> works;
  for (const double x_m : {60.0, 70.0, 80.0}) {
    works.push_back({.id = "works", .motion = drive_through({{0.0, {x_m, 0.0, 0.0}}})});
  }
  stand_behind(works);
  EXPECT_NEAR(blocked_at_s().value_or(1e9), 10.0, 0.051);
  EXPECT_EQ(look(20.0)->blockers.size(), 3U);
}

TEST_F(BehindSomebody, NothingIsBlockedWhereARuleIsWaitedForOrTheVehicleMoves) {
  stand_behind({car_at("first", 60.0)});
  for (int k = 0; k < 300; ++k) EXPECT_FALSE(look(0.1 * k, /*waits_for_rule=*/true));
  measured_.speed_mps = 0.5;
  for (int k = 300; k < 600; ++k) EXPECT_FALSE(look(0.1 * k));
}

TEST_F(BehindSomebody, AnObstacleClosesItsLaneForTheRearAxleWhereItLeavesNoRoom) {
  stand_behind({car_at("first", 60.0), car_at("aside", 100.0)});
  const double clearance_m = scenario_.options.clearance_m;
  const auto closed_by = [&](std::size_t obstacle) {
    const planning::DetourQuestion question{.task = *world_,
                                            .vehicle = scenario_.vehicle,
                                            .driving = scenario_.options,
                                            .measured = measured_,
                                            .t_s = 0.0,
                                            .blockers = {}};
    return planning::stretches_closed_by(world_->obstacles[obstacle], question);
  };
  ASSERT_EQ(closed_by(0).size(), 1U);
  const map::StationRange closed = closed_by(0).front().stations;
  EXPECT_NEAR(closed.from_s_m, 57.75 - scenario_.vehicle.front_m() - clearance_m, 1e-6);
  EXPECT_NEAR(closed.to_s_m, 62.25 + scenario_.vehicle.rear_overhang_m + clearance_m, 1e-6);
  // The lane is 4 m wide; 1.61 m and twice 0.3 m have to be left beside a body 1.8 m wide.
  const double room_m = scenario_.vehicle.width_m + 2.0 * clearance_m;
  const auto put_aside = [&](double left_m) {
    world_->obstacles[1].motion = drive_through({{0.0, {100.0, 2.0 - left_m - 0.9, 0.0}}});
  };
  put_aside(room_m - 0.05);
  EXPECT_EQ(closed_by(1).size(), 1U) << "the route's lane, however much room there is";
  world_->route.legs.clear();
  EXPECT_EQ(closed_by(1).size(), 1U);
  put_aside(room_m + 0.05);
  EXPECT_TRUE(closed_by(1).empty());
}

}  // namespace
}  // namespace roadbed::tools
