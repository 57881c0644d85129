// Letting in one where the lane beside ends: whom, and how in the closed loop.
#include "roadbed/planning/maneuvers/letting_in.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/planning/maneuvers/made_scenario.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kLaneEnds_m = 300.0, kOwnLane_m = -1.75, kOtherLane_m = -5.25;

/// Two lanes eastwards, of which the right one ends at x = 300; the marking between may be crossed,
/// or not. The vehicle drives in the left one.
Scenario scenario_of(double start_m, double speed_mps, const std::string& crossed = "both") {
  const std::string mark =
      fmt::format(R"(<roadMark sOffset="0" type="{}" color="white" laneChange="{}"/>)",
                  crossed == "none" ? "solid" : "broken", crossed);
  tests::MadeRoad road;
  road.id = "1";
  road.length_m = 1000.0;
  road.type = R"(<type s="0" type="rural"><speed max="30" unit="m/s"/></type>)";
  road.lanes =
      tests::made_section(0.0, "",
                          tests::made_lane(-1, R"(<link><successor id="-1"/></link>)" + mark) +
                              tests::made_lane(-2, mark)) +
      tests::made_section(kLaneEnds_m, "",
                          tests::made_lane(-1, R"(<link><predecessor id="-1"/></link>)"));
  Scenario scenario;
  scenario.file = "letting_in.json";
  scenario.map_file = tests::made_file("letting_in_" + crossed, road);
  scenario.start = place("0/-1", start_m);
  scenario.goal = place("1/-1", 500.0);
  scenario.start_speed_mps = speed_mps;
  scenario.options.desired_speed_mps = speed_mps;
  scenario.duration_s = 60.0;
  return scenario;
}

/// A car whose front is so far before the lane's end.
planning::Obstacle car(const std::string& id, double to_end_m, double d_m, double speed_mps) {
  const double x_m = kLaneEnds_m - to_end_m - 0.5 * kCar_m;
  const geometry::TrajectoryPoint now{.x_m = x_m, .y_m = d_m, .speed_mps = speed_mps};
  geometry::TrajectoryPoint later = now;
  later.t_s = 10.0;
  later.x_m += 10.0 * speed_mps;
  return {
      .id = id, .length_m = kCar_m, .width_m = 1.8, .motion = geometry::Trajectory({now, later})};
}

/// Whom the vehicle lets in whose front is so far before the lane's end.
planning::LettingIn::Decision look_at(const std::vector<planning::Obstacle>& others,
                                      double to_end_m, double speed_mps,
                                      const std::string& crossed = "both", double d_m = 0.0) {
  const Scenario scenario = scenario_of(20.0, 5.0, crossed);
  const World world = make_world(scenario);
  planning::LettingIn letting_in(scenario.vehicle, world);
  const double s_m =
      world.line.project({kLaneEnds_m, kOwnLane_m}).s_m - to_end_m - scenario.vehicle.front_m();
  return letting_in.look({0.0, {s_m, d_m}, speed_mps, planning::Traffic{others}});
}

TEST(LettingIn, TheForemostInTheLaneThatEndsIsFollowedAsIfItWereInTheOwnOne) {
  const auto decision = look_at(
      {car("second", 20.0, kOtherLane_m, 2.0), car("first", 5.0, kOtherLane_m, 1.0)}, 40.0, 5.0);
  ASSERT_TRUE(decision.behind);
  EXPECT_EQ(decision.behind->obstacle, 1U);
  EXPECT_NEAR(decision.behind->gap_m, 40.0 - 5.0 - kCar_m, 1e-3);  // bumper to bumper
  EXPECT_NEAR(decision.behind->speed_mps, 1.0, 1e-9);
  EXPECT_EQ(decision.reason, "lets car first in, whose lane ends in 5 m");
}

TEST(LettingIn, WhoDrivesAheadLetsInItsOwnOneFirst) {
  const auto decision =
      look_at({car("first", 5.0, kOtherLane_m, 1.0), car("second", 15.0, kOtherLane_m, 1.0),
               car("drives ahead", 25.0, kOwnLane_m, 1.0)},
              40.0, 5.0);
  ASSERT_TRUE(decision.behind);
  EXPECT_EQ(decision.behind->obstacle, 1U);
}

TEST(LettingIn, NobodyIsLetInFromBehindOrWhereItTakesHardBrakingOrALineNotToBeCrossed) {
  const auto waits = [](double to_end_m) {
    return std::vector{car("waits", to_end_m, kOtherLane_m, 0.0)};
  };
  EXPECT_TRUE(look_at(waits(5.0), 40.0, 8.0).behind);
  EXPECT_FALSE(look_at(waits(45.0), 40.0, 8.0).behind);         // is behind
  EXPECT_FALSE(look_at(waits(5.0), 25.0, 8.0).behind);          // 2.1 m/s² to stand behind it
  EXPECT_TRUE(look_at(waits(5.0), 26.0, 8.0).behind);           // 1.9 m/s²
  EXPECT_FALSE(look_at(waits(5.0), 40.0, 8.0, "none").behind);  // a solid line between
  EXPECT_FALSE(look_at(waits(51.0), 90.0, 8.0).behind);         // not its turn yet
  EXPECT_FALSE(look_at(waits(5.0), 40.0, 8.0, "both", -3.5).behind);  // the vehicle is there itself
  EXPECT_FALSE(look_at({car("oncoming", 5.0, kOtherLane_m, -3.0)}, 40.0, 8.0).behind);
  EXPECT_FALSE(look_at({car("in the lane", 5.0, kOwnLane_m, 1.0)}, 40.0, 8.0).behind);
}

// The other changes lanes 25 m before its end, whether it is let in or not. Who waits until it is
// in the way brakes hard; who lets it in has the room by then.
TEST(LettingIn, HasTheRoomBeforeTheOtherComes) {
  for (const double speed_mps : {5.0, 8.0, 12.0}) {
    SCOPED_TRACE(testing::Message() << speed_mps << " m/s");
    const double other_mps = 0.6 * speed_mps;
    // After 4 s it is 50 m before its end, and the vehicle so far behind that braking by 2 m/s²
    // does.
    const double behind_m =
        6.0 + (speed_mps * speed_mps - other_mps * other_mps) / (2.0 * 2.0) + kCar_m;
    const double start_m =
        kLaneEnds_m - 50.0 - behind_m - geometry::VehicleShape{}.front_m() - 4.0 * speed_mps;
    Scenario scenario = scenario_of(start_m, speed_mps);
    scenario.goal.text = "lane:1/1/-1@250";
    scenario.duration_s = 150.0;
    const double other_m = kLaneEnds_m - 50.0 - 0.5 * kCar_m - 4.0 * other_mps;
    scenario.obstacles = {
        {.id = "other",
         .length_m = kCar_m,
         .motion = TrafficObstacle{place("0/-2", other_m),
                                   ScenarioPlace{.text = "lane:1/1/-1@600", .pointer = "/test"},
                                   {{0.0, other_mps}}}}};
    World world = make_world(scenario);
    const Drive driven = drive(scenario, world);
    EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
    const bool lets_in = std::ranges::any_of(driven.cycles, [](const DriveCycle& cycle) {
      return cycle.reason.starts_with("lets car other in");
    });
    EXPECT_TRUE(lets_in);
    double hardest_mps2 = 0.0;
    for (const auto& row : driven.trajectory.points()) {
      if (row.x_m > 400.0) break;  // beyond, it stops at the goal
      hardest_mps2 = std::max(hardest_mps2, -row.acceleration_mps2);
    }
    EXPECT_LT(hardest_mps2, 2.2);  // the cruise control alone: 2.45
    for (const DriveSample& sample : driven.samples) EXPECT_GT(sample.clearance_m, 1.0);
  }
}

}  // namespace
}  // namespace roadbed::tools
