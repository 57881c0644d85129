// Drives at the speeds of a motorway, 15 to 36 m/s.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/behaviour/planner.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kLane_m = 3.5, kStart_m = 20.0;

/// Three lanes eastwards; the vehicle drives in the rightmost one.
Scenario scenario_at(double speed_mps) {
  const std::string mark =
      R"(<roadMark sOffset="0" type="broken" color="white" laneChange="both"/>)";
  tests::MadeRoad road;
  road.id = "1";
  road.length_m = 3000.0;
  road.type = R"(<type s="0" type="motorway"><speed max="40" unit="m/s"/></type>)";
  road.lanes = tests::made_section(
      0.0, "",
      tests::made_lane(-1, mark) + tests::made_lane(-2, mark) + tests::made_lane(-3, mark));
  Scenario scenario;
  scenario.file = "motorway.json";
  scenario.map_file = tests::made_file("motorway", road);
  scenario.start = {.text = fmt::format("lane:1/0/-3@{}", kStart_m), .pointer = "/start"};
  scenario.goal = {.text = "lane:1/0/-3@2900", .pointer = "/goal"};
  scenario.start_speed_mps = speed_mps;
  scenario.options.desired_speed_mps = speed_mps;
  scenario.duration_s = 25.0;
  return scenario;
}

ScenarioObstacle car(const std::string& id, int lane, double s_m, std::vector<TimedSpeed> speeds) {
  return {.id = id,
          .motion = TrafficObstacle{
              {.text = fmt::format("lane:1/0/{}@{}", lane, s_m), .pointer = "/test"},
              {},
              std::move(speeds)}};
}

TEST(MotorwayDrives, StopBehindALeadThatBrakesBesideLanesThatAreTaken) {
  for (const double braking_mps2 : {4.0, 6.0, 8.0}) {
    for (const double speed_mps : {25.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << braking_mps2 << " m/s² from " << speed_mps << " m/s");
      Scenario scenario = scenario_at(speed_mps);
      const double gap_m = 5.0 + 1.5 * speed_mps + 4.5;
      scenario.obstacles = {
          car("lead", -3, kStart_m + gap_m,
              {{0.0, speed_mps}, {4.0, speed_mps}, {4.0 + speed_mps / braking_mps2, 0.0}}),
          car("beside", -2, kStart_m + 10.0, {{0.0, speed_mps}}),
          car("beside, ahead", -2, kStart_m + 40.0, {{0.0, speed_mps}})};
      World world = make_world(scenario);
      const Drive driven = drive(scenario, world);
      EXPECT_NE(driven.verdict.outcome, Outcome::collision) << driven.verdict.text;
      for (const DriveSample& sample : driven.samples) EXPECT_GT(sample.clearance_m, 0.29);
    }
  }
}

TEST(MotorwayDrives, ComeBackToTheMiddleOfTheirLane) {
  for (const double speed_mps : {15.0, 22.0, 30.0, 36.0}) {
    SCOPED_TRACE(testing::Message() << speed_mps << " m/s");
    Scenario scenario = scenario_at(speed_mps);
    const double middle_m = -2.5 * kLane_m;
    scenario.start = {.text = fmt::format("{},{},0", kStart_m, middle_m + 1.1),
                      .pointer = "/start"};
    World world = make_world(scenario);
    const Drive driven = drive(scenario, world);
    for (const auto& row : driven.trajectory.points()) {
      if (row.t_s < 10.0) continue;
      EXPECT_NEAR(row.y_m, middle_m, 0.1) << row.t_s;
    }
  }
}

TEST(MotorwayDrives, PassWhoStandsInTheirLaneThroughAFreeOne) {
  Scenario scenario = scenario_at(30.0);
  scenario.obstacles = {
      {.id = "stands",
       .motion = ParkedObstacle{ParkedObstacle::Beside{
           {.text = fmt::format("lane:1/0/-3@{}", kStart_m + 300.0), .pointer = "/test"}}}}};
  World world = make_world(scenario);
  const Drive driven = drive(scenario, world);
  for (const auto& row : driven.trajectory.points()) {
    EXPECT_GT(row.speed_mps, 15.0) << row.t_s;  // to pass within its own lane it slows to 5
    if (std::abs(row.x_m - kStart_m - 300.0) > 8.0) continue;
    EXPECT_NEAR(row.y_m, -1.5 * kLane_m, 0.5);
  }
  EXPECT_GT(driven.trajectory.points().back().x_m, 600.0);
}

}  // namespace
}  // namespace roadbed::tools
