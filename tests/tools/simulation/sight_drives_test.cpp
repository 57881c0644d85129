// Drives among others who are measured, foreseen, or hidden.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "roadbed/tests/support/driven_scenario.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

using tests::driven;
using tests::expect_arrives;
using tests::scenario_of;
using Driven = tests::DrivenScenario;

TEST(SightDrives, PedestrianIsGivenRoomInGoodTimeWhereItIsKnownThatHeWillCross) {
  expect_arrives(driven(scenario_of("pedestrian"), {.predicts = false}), 1.0);
}

/// He stands, and then steps onto the road.
TEST(SightDrives, PedestrianIsGivenRoomWhereThatHasToBeSeen) {
  const Driven d = driven("pedestrian");
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  EXPECT_GE(d.clearance_m(), 1.0);
  for (const auto& row : d.drive.trajectory.points()) EXPECT_GE(row.acceleration_mps2, -3.0);
}

/// Scripts of walkers have all kinds of headings.
TEST(SightDrives, PedestrianIsGivenRoomWhereverHeLooks) {
  for (const double heading_rad : {0.0, 0.5 * M_PI, M_PI, -0.5 * M_PI}) {
    Scenario scenario = scenario_of("pedestrian");
    auto& walk = std::get<ScriptedObstacle>(scenario.obstacles[0].motion);
    for (TimedPose& at : walk.poses) at.pose.heading_rad = heading_rad;
    const Driven d = driven(scenario);
    EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached)
        << heading_rad << ": " << d.drive.verdict.text;
    EXPECT_GE(d.clearance_m(), 1.0) << heading_rad;
  }
}

/// Between two parked cars, 1 m and more beside the way, whenever he sets off.
TEST(SightDrives, WhoStepsOutFromBetweenParkedCarsIsNotDrivenInto) {
  const Scenario base = scenario_of("parked_car");
  const World world = make_world(base);
  const auto beside = [&](double s_m, double d_m) {
    const Place place = find_place(world.road_map, fmt::format("lane:1/3/1@{}", s_m));
    return place.map_from_vehicle * geometry::Pose2{0.0, d_m, 0.0};
  };
  const auto parked = [](const char* id, double s_m) {
    return ScenarioObstacle{
        .id = id,
        .motion = ParkedObstacle{ParkedObstacle::Beside{
            {.text = fmt::format("lane:1/3/1@{}", s_m), .pointer = "/test"}, -2.7}}};
  };
  for (double from_s = 0.5; from_s <= 8.0; from_s += 0.1) {
    Scenario scenario = base;
    scenario.obstacles = {parked("first", 50.0), parked("second", 56.0)};
    const double walk_s = 8.0 / 1.4;
    scenario.obstacles.push_back(
        {.id = "walker",
         .kind = "pedestrian",
         .length_m = 0.5,
         .width_m = 0.5,
         .motion = ScriptedObstacle{
             {{from_s, beside(53.0, -4.0)}, {from_s + walk_s, beside(53.0, 4.0)}}}});
    const Driven d = driven(scenario);
    const std::optional<Collision>& collision = d.drive.collision;
    EXPECT_FALSE(collision && collision->is_at_fault) << from_s << ": " << d.drive.verdict.text;
  }
}

TEST(SightDrives, OneStopsWithinWhatIsSeen) {
  for (const double range_m : {20.0, 40.0, 80.0}) {
    Scenario scenario = scenario_of("slower_lead");
    scenario.noise.object_range_m = range_m;
    scenario.obstacles = {{.id = "broken down",
                           .motion = ParkedObstacle{ParkedObstacle::Beside{
                               {.text = "lane:5/0/-1@200", .pointer = "/test"}, 0.0}}}};
    const Driven d = driven(scenario);
    EXPECT_NE(d.drive.verdict.outcome, Outcome::collision)
        << range_m << ": " << d.drive.verdict.text;
    EXPECT_GT(d.clearance_m(), 0.25) << range_m;
  }
}

/// As sensors measure, and twice that.
ScenarioNoise noise_of_all(double times) {
  return {
      .gap_m = 0.25 * times,
      .relative_speed_mps = 0.1 * times,
      .acceleration_mps2 = 0.05 * times,
      .position_m = 0.02 * times,
      .heading_rad = 0.002 * times,
      .speed_mps = 0.05 * times,
      .object = {.position_m = 0.1 * times, .heading_rad = 0.02 * times, .speed_mps = 0.2 * times}};
}

TEST(SightDrives, NoiseAndTwiceTheNoiseCostNoGoal) {
  for (const char* name : {"closed_road", "cut_in", "narrowing", "overtake", "way_points"}) {
    for (const double times : {1.0, 2.0}) {
      for (const std::uint64_t seed : {1, 3}) {
        Scenario scenario = scenario_of(name);
        scenario.noise = noise_of_all(times);
        scenario.seed = seed;
        const Driven d = driven(scenario);
        SCOPED_TRACE(
            fmt::format("{}, {} times, seed {}: {}", name, times, seed, d.drive.verdict.text));
        EXPECT_THAT(d.drive.verdict.text, testing::StartsWith("goal reached"));
        EXPECT_LT(d.off_road_m(), 0.02 * times) << "the deviation of where it is";
      }
    }
  }
}

TEST(SightDrives, TheVerdictSaysThatTheFutureWasKnown) {
  const auto text_of = [](const std::string& name, bool predicts) {
    return driven(scenario_of(name), {.predicts = predicts}).drive.verdict.text;
  };
  using testing::EndsWith;
  EXPECT_THAT(text_of("slower_lead", false), EndsWith("; the others' future was known"));
  EXPECT_THAT(text_of("slower_lead", true), testing::Not(EndsWith("known")));
  Scenario noisy = scenario_of("slower_lead");
  noisy.noise.object.position_m = 0.3;
  EXPECT_THAT(driven(noisy, {.predicts = false}).drive.verdict.text,
              EndsWith("; the others' future was known, without their noise"));
  EXPECT_THAT(text_of("parked_car", false), testing::Not(EndsWith("known"))) << "nobody moves";
}

/// A hedge hides who comes from the left, and a car comes, sooner or later.
TEST(SightDrives, OutOfABlindCornerOneCreepsUntilMoreIsSeen) {
  int creeps = 0;
  for (double from_m = 450.0; from_m <= 705.0; from_m += 15.0) {
    Scenario scenario = scenario_of("blind_corner");
    auto& motion = std::get<TrafficObstacle>(scenario.obstacles[1].motion);
    motion.start.text = fmt::format("lane:1/0/-1@{}", from_m);
    const Driven d = driven(scenario);
    SCOPED_TRACE(from_m);
    expect_arrives(d, 0.5);
    creeps += d.first(planning::Behaviour::yield, "somebody hidden may come on lane ") ? 1 : 0;
    // It has to brake by 3.5 m/s² at most, until it comes to where its lanes end.
    const planning::Obstacle& other = d.world.obstacles[1];
    for (double t_s = 0.5; t_s < (1050.0 - from_m) / 14.0; t_s += 0.1) {
      EXPECT_GE(other.motion.at(t_s).speed_mps - other.motion.at(t_s - 0.5).speed_mps, -1.75)
          << t_s;
    }
  }
  EXPECT_GE(creeps, 8) << "of 18; else it remembers who is hidden";
}

/// Another hedge on the right, and who comes from the left does not brake for anybody.
TEST(SightDrives, OutOfACornerThatIsBlindToBothSidesNobodyIsTouched) {
  for (double from_m = 480.0; from_m <= 600.0; from_m += 20.0) {
    Scenario scenario = scenario_of("blind_corner");
    ScenarioObstacle right = scenario.obstacles[0];
    right.id = "hedge on the right";
    std::get<geometry::Pose2>(std::get<ParkedObstacle>(right.motion).at).x_m = 926.0;
    scenario.obstacles.push_back(right);
    scenario.obstacles[1].motion = ScriptedObstacle{
        {{0.0, {from_m, -1.75, 0.0}}, {(1200.0 - from_m) / 14.0, {1200.0, -1.75, 0.0}}}};
    const Driven d = driven(scenario);
    EXPECT_NE(d.drive.verdict.outcome, Outcome::collision)
        << from_m << ": " << d.drive.verdict.text;
    EXPECT_GT(d.clearance_m(), 0.25) << from_m;
  }
}

}  // namespace
}  // namespace roadbed::tools
