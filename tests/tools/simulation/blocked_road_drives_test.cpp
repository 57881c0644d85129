// Drives in town behind what stands for ever, or only for a while.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "roadbed/tests/support/driven_scenario.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;
using tests::driven;
using Driven = tests::DrivenScenario;

bool passes_lane(const Driven& d, const std::string& lane) {
  return std::ranges::any_of(d.world.route.legs, [&](const planning::RouteLeg& leg) {
    return d.world.road_map.lane(leg.lane).name == lane;
  });
}

/// Events that the road is blocked.
std::vector<DriveEvent> blocked_events(const Driven& d) {
  std::vector<DriveEvent> found;
  std::ranges::copy_if(d.drive.events, std::back_inserter(found), [](const DriveEvent& event) {
    return event.text.starts_with("the road is blocked");
  });
  return found;
}

Scenario closed_road() { return tests::scenario_of("closed_road"); }

ScenarioObstacle barrier(const std::string& id, const std::string& place, double width_m = 4.2) {
  return {.id = id,
          .kind = "barrier",
          .length_m = 0.6,
          .width_m = width_m,
          .motion = ParkedObstacle{ParkedObstacle::Beside{{place, "/obstacles/0"}, 0.0}}};
}

ScenarioObstacle car(const std::string& id, const std::string& place, const std::string& to,
                     std::vector<TimedSpeed> speeds) {
  return {.id = id,
          .motion = TrafficObstacle{
              {place, "/obstacles/0"}, ScenarioPlace{to, "/obstacles/0"}, std::move(speeds)}};
}

/// Whatever is driven, on every route of it.
void expect_keeps_the_rules(const Driven& d) {
  for (const auto& row : d.drive.trajectory.points()) EXPECT_GE(row.speed_mps, 0.0);
  for (const DriveSample& sample : d.drive.samples) EXPECT_EQ(sample.off_road_m, 0.0);
  for (std::size_t i = 1; i < d.drive.samples.size(); ++i) {
    EXPECT_GE(d.drive.samples[i].s_m, d.drive.samples[i - 1].s_m - 0.01);
  }
  for (const planning::RouteLeg& leg : d.world.route.legs) {
    const map::LaneLinks& links = d.world.road_map.graph().of(leg.lane);
    const bool leaves_left = leg.exit == planning::LegExit::change_left;
    const bool leaves_right = leg.exit == planning::LegExit::change_right;
    EXPECT_TRUE(!leaves_left || links.left->change_allowed());
    EXPECT_TRUE(!leaves_right || links.right->change_allowed());
  }
}

TEST(BlockedRoadDrives, WhoDrivesOnBeforeTenSecondsIsFollowed) {
  Scenario scenario = closed_road();
  scenario.obstacles = {
      car("lorry", "lane:2202/0/-1@12", "lane:1/3/-1@100", {{0.0, 0.0}, {22.0, 0.0}, {28.0, 8.0}})};
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  EXPECT_TRUE(blocked_events(d).empty());
  EXPECT_TRUE(d.drive.given_up.empty());
  // It stood behind the lorry: from 15 s on, for less than 10 s.
  EXPECT_LT(d.drive.trajectory.at(22.0).speed_mps, 0.05);
  expect_keeps_the_rules(d);
}

TEST(BlockedRoadDrives, BehindALorryThatStandsInTheStreetThereIsNoOtherRouteAndItSaysSo) {
  Scenario scenario = closed_road();
  scenario.obstacles = {barrier("works", "lane:2/3/1@30", 8.0)};
  scenario.duration_s = 60.0;
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::stopped);
  EXPECT_THAT(
      d.drive.verdict.text,
      HasSubstr("the road is blocked: barrier works has not moved for 10 s; no other route: "
                "no lane sequence leads from lane 2/3/1 to lane 1/3/-1"));
  EXPECT_EQ(blocked_events(d).size(), 1U);
  EXPECT_EQ(d.drive.cycles.back().behaviour, planning::Behaviour::stop);
  EXPECT_TRUE(d.drive.given_up.empty());
  expect_keeps_the_rules(d);
}

/// The roundabout's exit and its ring part slowly: what counts is where the vehicle has come to.
TEST(BlockedRoadDrives, AnExitThatHasBeenEnteredIsLeftWhereAPathStillLeadsOut) {
  const auto with_barrier_at = [](double s_m) {
    Scenario scenario = closed_road();
    scenario.obstacles = {barrier("works", fmt::format("lane:2202/0/-1@{}", s_m))};
    scenario.duration_s = 40.0;
    return driven(scenario);
  };
  const Driven in_mouth = with_barrier_at(10.0);
  ASSERT_EQ(in_mouth.drive.given_up.size(), 1U);
  EXPECT_EQ(in_mouth.world.road_map.lane(in_mouth.world.route.legs[0].lane).name, "2200/0/-1");
  EXPECT_THAT(blocked_events(in_mouth).at(0).text, HasSubstr("(+49")) << "against the blocked way";
  EXPECT_GT(in_mouth.drive.samples.back().s_m, 100.0);
  const Driven half_in = with_barrier_at(12.0);
  EXPECT_THAT(blocked_events(half_in).at(0).text,
              HasSubstr("no other route: no path leads past what stands there to lane 2200/0/-1"));
  const Driven in_exit = with_barrier_at(15.0);
  EXPECT_THAT(blocked_events(in_exit).at(0).text,
              HasSubstr("no lane sequence leads from lane 2202/0/-1 to lane 1/3/-1"));
}

TEST(BlockedRoadDrives, WhatClosedTheFirstWayIsKnownWhereTheSecondIsClosedToo) {
  Scenario scenario = closed_road();
  scenario.goal = {"lane:3/0/-1@20", "/goal"};
  scenario.obstacles.push_back(barrier("south", "lane:2302/0/-1@9.2"));
  scenario.duration_s = 250.0;
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  ASSERT_EQ(d.drive.given_up.size(), 2U);
  EXPECT_EQ(d.world.blockers.size(), 2U);
  EXPECT_TRUE(passes_lane(d, "6/0/1"));  // by the bypass, the only way that is left
  EXPECT_GT(d.drive.samples.back().s_m, 1500.0);
  EXPECT_NEAR(d.drive.last_line_from_s_m + d.world.line.goal_s_m(), d.drive.samples.back().s_m,
              1.0);
  expect_keeps_the_rules(d);
}

TEST(BlockedRoadDrives, ALaneIsLeftBeforeTheBarrierWhereThereIsRoomToChange) {
  Scenario scenario = closed_road();
  scenario.start = {"lane:30/2/-3@2", "/ego/start"};
  scenario.obstacles = {barrier("ramp", "lane:3002/0/-1@8")};
  scenario.options.standstill_gap_m = 20.0;
  scenario.duration_s = 250.0;
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  ASSERT_EQ(d.drive.given_up.size(), 1U);
  EXPECT_EQ(d.world.route.legs.front().exit, planning::LegExit::change_left);
  expect_keeps_the_rules(d);
}

TEST(BlockedRoadDrives, WhoStandsInTheLaneThatIsMergedIntoIsBrakedForInTime) {
  Scenario scenario = closed_road();
  scenario.start = {"lane:30/2/-2@5", "/ego/start"};
  scenario.start_speed_mps = 10.0;
  scenario.obstacles = {barrier("ramp", "lane:3002/0/-1@8")};
  scenario.options.standstill_gap_m = 20.0;
  scenario.duration_s = 20.0;
  const Driven d = driven(scenario);
  for (const DriveCycle& cycle : d.drive.cycles) {
    EXPECT_NE(cycle.behaviour, planning::Behaviour::emergency) << cycle.t_s << cycle.reason;
  }
  EXPECT_NEAR(d.drive.cycles.back().lead->gap_m, 20.0, 1.0);
}

/// Two cars that wait at the light before the crossroads until it is green.
TEST(BlockedRoadDrives, AQueueAtARedLightIsWaitedBehind) {
  Scenario scenario = tests::scenario_of("red_light");
  const double leaves_s = 45.0;
  scenario.lights.front().phases.front().duration_s = leaves_s;  // red
  scenario.duration_s = 90.0;
  for (const double behind_m : {0.0, 7.0}) {
    scenario.obstacles.push_back(car(
        fmt::format("car {}", behind_m), fmt::format("lane:1/0/2@{}", 11.0 - behind_m),
        "lane:2/3/-1@69", {{0.0, 0.0}, {leaves_s + 0.2 * behind_m, 0.0}, {leaves_s + 4.0, 10.0}}));
  }
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  EXPECT_TRUE(blocked_events(d).empty());
  for (double t_s = 30.0; t_s < leaves_s; t_s += 0.1) {
    EXPECT_LT(d.drive.trajectory.at(t_s).speed_mps, 0.05) << t_s;
  }
}

TEST(BlockedRoadDrives, ATrafficJamThatMovesInBetweenIsWaitedBehind) {
  Scenario scenario = closed_road();
  std::vector<TimedSpeed> speeds;
  for (double t_s = 0.0; t_s < 80.0; t_s += 9.0) {
    for (const TimedSpeed at : {TimedSpeed{0.0, 0.0}, {7.0, 0.0}, {7.5, 1.0}, {8.5, 1.0}}) {
      speeds.push_back({t_s + at.t_s, at.speed_mps});
    }
  }
  scenario.obstacles = {car("first", "lane:2202/0/-1@20", "lane:1/3/-1@100", speeds),
                        car("last", "lane:2202/0/-1@12", "lane:1/3/-1@100", speeds)};
  scenario.duration_s = 70.0;
  const Driven d = driven(scenario);
  EXPECT_TRUE(blocked_events(d).empty());
  EXPECT_EQ(d.drive.cycles.back().lead->id, "last");
  expect_keeps_the_rules(d);
}

}  // namespace
}  // namespace roadbed::tools
