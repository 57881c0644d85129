// The scenarios of data/scenarios, each for one thing that traffic asks for.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/driven_scenario.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

using tests::driven;
using tests::expect_arrives;
using tests::scenario_of;
using Driven = tests::DrivenScenario;

TEST(ScenarioDrives, WayPointsAreDrivenRoundTheirCornerPastWhatIsParked) {
  const Driven d = driven("way_points");
  expect_arrives(d, 0.29);
  // The corner's legs are 88 m and 58 m long: rounded so that no speed is lost, away from it.
  double nearest_m = 1e9, slowest_mps = 1e9;
  for (const auto& row : d.drive.trajectory.points()) {
    if (row.y_m < -40.0) break;
    nearest_m = std::min(nearest_m, std::hypot(row.x_m - 918.25, row.y_m + 1.75));
    slowest_mps = std::min(slowest_mps, row.speed_mps);
  }
  EXPECT_NEAR(nearest_m, 3.5, 1.0);
  EXPECT_GT(slowest_mps, 4.0);
  const auto& end = d.drive.trajectory.points().back();
  EXPECT_NEAR(std::hypot(end.x_m - 918.25, end.y_m + 120.0), 0.0, 1.0);
}

TEST(ScenarioDrives, WayPointsLeadBetweenWallsOfTheOccupancy) {
  Scenario scenario = scenario_of("narrow_gap");
  scenario.way_points = {
      .places = {{"lane:1/3/1@60", "/way_points/0"}, {"lane:1/3/1@105", "/way_points/1"}}};
  const Driven d = driven(scenario);
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  EXPECT_TRUE(d.world.route.legs.empty());
  EXPECT_NE(d.world.field, nullptr);
}

std::string refusal_of(ScenarioWayPoints way_points) {
  Scenario scenario = scenario_of("way_points");
  scenario.way_points = std::move(way_points);
  try {
    make_world(scenario);
  } catch (const map::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ScenarioDrives, WayPointsThatMakeNoLineAreRefusedAtTheirPlace) {
  using testing::HasSubstr;
  const auto at = [](const char* text) { return ScenarioPlace{text, "/way_points/0"}; };
  EXPECT_THAT(refusal_of({.places = {at("700,-1.75")}}),
              HasSubstr("way_points.json:/way_points/0: lies behind the vehicle"));
  EXPECT_THAT(refusal_of({.places = {at("830,-1.75")}}),
              HasSubstr("way_points.json:/way_points: make no line: path_through: needs at least "
                        "two distinct way-points"));
  EXPECT_THAT(refusal_of({.places = {at("lane:none")}}), HasSubstr("/way_points/0: "));
  EXPECT_THAT(refusal_of({.places = {at("900,-1.75,0")}}),
              HasSubstr("/way_points/0: has a heading"));
  EXPECT_THAT(refusal_of({.places = {at("900,-1.75")}, .half_width_m = 0.7}),
              HasSubstr("/half_width_m: 0.7 m to each side"));
}

/// Of the obstacle that is nearest to the vehicle at a time, ahead or behind in its lane.
std::string next_to(const Driven& d, double t_s, bool ahead) {
  std::string id;
  double least_m = 1e9;
  const double x_m = d.drive.trajectory.at(t_s).x_m;
  for (const planning::Obstacle& other : d.world.obstacles) {
    const double away_m = (ahead ? 1.0 : -1.0) * (other.motion.at(t_s).x_m - x_m);
    if (away_m > 0.0 && away_m < least_m) least_m = away_m, id = other.id;
  }
  return id;
}

TEST(ScenarioDrives, AtTheEndOfTheLaneOneCarOfTheQueueLetsTheVehicleIn) {
  const Driven d = driven("zip");
  expect_arrives(d, 1.0);
  EXPECT_NE(d.first(planning::Behaviour::yield, "no gap to merge into: "), nullptr);
  // The lane ends at x = 660 m; from 640 m on it waits, and at most two pass it.
  EXPECT_LT(d.passes_x_at_s(645.0) - d.passes_x_at_s(639.0), 10.0);
  const double merged_s = d.passes_x_at_s(662.0);
  EXPECT_NEAR(d.drive.trajectory.at(merged_s).y_m, -1.75, 0.5);
  EXPECT_EQ(next_to(d, merged_s, true), "queue 14");
  EXPECT_EQ(next_to(d, merged_s, false), "queue 15");
  // The one that lets it in follows; everybody else had no more reason to brake than before.
  double hardest_mps2 = 0.0;
  for (const planning::Obstacle& other : d.world.obstacles) {
    for (double t_s = 0.5; t_s < 50.0; t_s += 0.1) {
      const double braked_mps =
          other.motion.at(t_s - 0.5).speed_mps - other.motion.at(t_s).speed_mps;
      hardest_mps2 = std::max(hardest_mps2, braked_mps / 0.5);
    }
  }
  EXPECT_LT(hardest_mps2, 2.1);
}

TEST(ScenarioDrives, RampGivesWayToTheRoadThatItJoins) {
  const Driven d = driven("ramp");
  expect_arrives(d, 1.0);
  EXPECT_NE(d.first(planning::Behaviour::yield, "join with lane 1000/0/-2: car bypass 2"), nullptr);
  // It joins between x = 325 m and 360 m, without making anybody brake.
  const double joined_s = d.passes_x_at_s(360.0);
  EXPECT_EQ(next_to(d, joined_s, true), "bypass 4");
  EXPECT_GT(d.speed_at(joined_s), 8.0);
  for (const planning::Obstacle& other : d.world.obstacles) {
    EXPECT_NEAR(other.motion.at(joined_s + 2.0).speed_mps, 16.0, 0.1) << other.id;
  }
}

TEST(ScenarioDrives, RedLightIsStoppedAtAndGreenIsDrivenOnAt) {
  const Driven d = driven("red_light");
  expect_arrives(d, 1.0);
  EXPECT_NE(d.first(planning::Behaviour::yield, "light 2 is red"), nullptr);
  // The light stands at x = 279 m and is red until 26 s.
  EXPECT_LT(d.speed_at(25.9), 0.05);
  const double front_m = d.drive.trajectory.at(25.9).x_m + geometry::VehicleShape{}.front_m();
  EXPECT_LT(front_m, 279.0);
  EXPECT_GT(front_m, 277.0);
  EXPECT_GT(d.passes_x_at_s(279.0), 26.0);
  EXPECT_LT(d.passes_x_at_s(279.0), 30.0);
}

TEST(ScenarioDrives, LightThatTurnsYellowIsNeverPassedAtRed) {
  Scenario scenario = scenario_of("red_light");
  int stops = 0;
  for (int k = 0; k < 12; ++k) {
    const double yellow_at_s = 11.0 + 0.3 * k;
    scenario.lights.front().phases = {{planning::LightColour::green, yellow_at_s},
                                      {planning::LightColour::yellow, 3.0},
                                      {planning::LightColour::red, 20.0},
                                      {planning::LightColour::green, 60.0}};
    const Driven d = driven(scenario);
    expect_arrives(d, 1.0);
    const double passes_s = d.passes_x_at_s(279.0);
    const bool stopped = passes_s > yellow_at_s + 23.0;
    EXPECT_TRUE(stopped || passes_s < yellow_at_s + 3.0)
        << "yellow at " << yellow_at_s << " s, passed at " << passes_s << " s";
    stops += stopped;
  }
  EXPECT_GT(stops, 3);
  EXPECT_LT(stops, 12);
}

TEST(ScenarioDrives, LightThatTurnsYellowAtFiftyIsNeverPassedAtRedEither) {
  // At 13.9 m/s and with 3 s of yellow, ¼ g stops from 50 m on, and driving on does from 42 m on.
  Scenario scenario = scenario_of("red_light");
  scenario.options.desired_speed_mps = scenario.start_speed_mps = 13.8;
  scenario.duration_s = 24.0;
  int hard = 0, stops = 0;
  for (int k = 0; k < 14; ++k) {
    const double yellow_at_s = 8.1 + 0.12 * k;
    scenario.lights.front().phases = {{planning::LightColour::green, yellow_at_s},
                                      {planning::LightColour::yellow, 3.0},
                                      {planning::LightColour::red, 60.0}};
    const Driven d = driven(scenario);
    const double passes_s = d.passes_x_at_s(279.0);
    stops += passes_s > scenario.duration_s;
    EXPECT_TRUE(passes_s > scenario.duration_s || passes_s < yellow_at_s + 3.0)
        << "yellow at " << yellow_at_s << " s, passed at " << passes_s << " s";
    if (const DriveCycle* braking = d.first(planning::Behaviour::emergency)) {
      ++hard;
      EXPECT_NE(braking->reason.find("light 2 is yellow"), std::string::npos) << braking->reason;
    }
    for (const auto& row : d.drive.trajectory.points()) EXPECT_GT(row.acceleration_mps2, -4.5);
  }
  EXPECT_GT(hard, 0);
  EXPECT_GT(stops, hard);
  EXPECT_LT(stops, 14);
}

TEST(ScenarioDrives, StopSignIsStoppedAtAndThenAGapIsTaken) {
  const Driven d = driven("stop_sign");
  expect_arrives(d, 1.5);
  EXPECT_NE(d.first(planning::Behaviour::yield, "stop sign 1 is"), nullptr);
  // The line is at y = −21 m; the drive comes from the south.
  double stands_s = 0.0, leaves_s = 1e9;
  for (const auto& row : d.drive.trajectory.points()) {
    const double front_m = row.y_m + geometry::VehicleShape{}.front_m();
    if (row.speed_mps < 0.05 && front_m > -22.5 && front_m < -21.0) stands_s = row.t_s;
    if (front_m > -20.5) leaves_s = std::min(leaves_s, row.t_s);
  }
  EXPECT_GT(stands_s, 5.0);
  EXPECT_GT(leaves_s, stands_s);
  EXPECT_NE(d.first(planning::Behaviour::yield, "would be met"), nullptr);
  // Nobody who has the right of way has to brake; at the end of its way a car rests.
  for (const planning::Obstacle& other : d.world.obstacles) {
    const auto& points = other.motion.points();
    for (std::size_t i = 1; i < points.size() && points[i].speed_mps > 0.0; ++i) {
      EXPECT_GE(points[i].speed_mps, points[i - 1].speed_mps - 1e-6) << other.id << points[i].t_s;
    }
  }
}

/// An obstacle that does what a drive did, some time later, but for the drive's last 10 s; before,
/// it comes straight on.
planning::Obstacle follower(const Driven& ahead, double later_s) {
  const auto& rows = ahead.drive.trajectory.points();
  const double to_centre_m =
      geometry::VehicleShape{}.front_m() - 0.5 * geometry::VehicleShape{}.length_m;
  const auto centre = [&](const geometry::Pose2& rear, double by_m) {
    const Eigen::Vector2d place = rear * Eigen::Vector2d(to_centre_m + by_m, 0.0);
    return geometry::Pose2{place.x(), place.y(), rear.heading_rad};
  };
  std::vector<TimedPose> poses{
      {0.0, centre(rows.front().pose(), -later_s * rows.front().speed_mps)}};
  for (const auto& row : rows) {
    if (row.t_s < rows.back().t_s - 10.0)
      poses.push_back({row.t_s + later_s, centre(row.pose(), 0.0)});
  }
  return {.id = "tail", .motion = drive_through(poses)};
}

TEST(ScenarioDrives, WhoFollowsIntoTheRoundaboutIsNotGivenWayTo) {
  const Scenario scenario = scenario_of("roundabout");
  Driven d{make_world(scenario), {}};
  d.world.obstacles.clear();
  d.drive = drive(scenario, d.world);
  d.world.obstacles = {follower(d, 1.8)};
  d.drive = drive(scenario, d.world);
  expect_arrives(d, 1.0);
  EXPECT_EQ(d.first(planning::Behaviour::yield), nullptr);
}

TEST(ScenarioDrives, LeftTurnWaitsForThoseWhoComeTheOtherWay) {
  const Driven d = driven("left_turn");
  expect_arrives(d, 1.0);
  EXPECT_NE(d.first(planning::Behaviour::yield, "left turn: car"), nullptr);
}

TEST(ScenarioDrives, RoundaboutIsEnteredBehindWhoIsInIt) {
  const Driven d = driven("roundabout");
  expect_arrives(d, 1.0);
  EXPECT_NE(d.first(planning::Behaviour::yield, "give way sign 7: car in the ring"), nullptr);
}

TEST(ScenarioDrives, StopAndGoWithLostMeasurementsIsFollowed) {
  const Driven d = driven("stop_and_go");
  expect_arrives(d, 1.5);
  const auto stands = [](const auto& row) { return row.t_s > 2.0 && row.speed_mps < 0.05; };
  EXPECT_TRUE(std::ranges::any_of(d.drive.trajectory.points(), stands));
}

TEST(ScenarioDrives, CarThatCutsInIsGivenRoomWithoutHardBraking) {
  const Driven d = driven("cut_in");
  expect_arrives(d, 0.3);
  EXPECT_NE(d.first(planning::Behaviour::follow, "cutter"), nullptr);
}

TEST(ScenarioDrives, LaneChangeOfTheRouteIsMade) {
  const Driven d = driven("lane_change");
  expect_arrives(d, 0.25);
}

// As in the paper's Fig. 8, but with its own speed control.
/// Begun slowly, the lane change ends behind the car, which parks there: 6 m are left to it.
TEST(ScenarioDrives, FromCloseBehindAParkedCarTheVehicleSetsOffRoundIt) {
  Scenario scenario = scenario_of("lane_change");
  scenario.start_speed_mps = 6.0;
  scenario.duration_s = 60.0;
  // That it parks is known, or found out when it has stood for 15 s.
  for (const auto& [predicts, until_s] : {std::pair{false, 35.0}, std::pair{true, 50.0}}) {
    const Driven d = driven(scenario, {.predicts = predicts});
    expect_arrives(d, 0.29);
    EXPECT_NE(d.first(planning::Behaviour::follow, "car behind"), nullptr);
    EXPECT_LT(d.drive.verdict.at_s, until_s);
  }
}

/// Two lanes that stop and go, each in its own time: who drives in the next one is not cut in on,
/// nor touched from the side on a path that has been begun.
TEST(ScenarioDrives, InAJamTheVehicleKeepsToItsLaneBesideWhoDrivesInTheNext) {
  const std::vector<TimedSpeed> own{{0.0, 5.8},  {3.0, 3.0},  {17.0, 3.0}, {19.5, 0.0}, {29.0, 0.0},
                                    {34.5, 3.0}, {37.5, 0.0}, {41.0, 0.0}, {47.0, 5.0}};
  const std::vector<TimedSpeed> next{{0.0, 3.0},  {3.0, 3.0},  {8.0, 0.0},
                                     {12.5, 0.0}, {15.0, 3.0}, {18.0, 3.0},
                                     {24.0, 0.0}, {32.5, 0.0}, {35.0, 5.0}};
  Scenario scenario = scenario_of("lane_change");
  scenario.start_speed_mps = 3.0;
  scenario.duration_s = 50.0;
  scenario.goal = {.text = "lane:31/0/-1@97", .pointer = "/goal"};
  scenario.obstacles.clear();
  const auto add = [&](const std::string& name, const std::string& place,
                       const std::vector<TimedSpeed>& speeds) {
    scenario.obstacles.push_back(
        {.id = name, .motion = TrafficObstacle{{.text = place, .pointer = "/test"}, {}, speeds}});
  };
  for (const int at_m : {18, 27, 38}) {
    add(fmt::format("own {}", at_m), fmt::format("lane:31/0/-1@{}", at_m), own);
  }
  for (const int at_m : {11, 24, 35}) {
    add(fmt::format("next {}", at_m), fmt::format("lane:31/0/-2@{}", at_m), next);
  }
  const Driven d = driven(scenario);
  EXPECT_NE(d.drive.verdict.outcome, Outcome::collision) << d.drive.verdict.text;
  EXPECT_GE(d.clearance_m(), 1.0);
  EXPECT_EQ(d.first(planning::Behaviour::emergency), nullptr);
}

TEST(ScenarioDrives, SlowerCarIsPassedInTheFreeLaneWithoutBraking) {
  const Driven d = driven("pass_car");
  expect_arrives(d, 1.5);
  const DriveCycle* passes = d.first(planning::Behaviour::pass, "passes slower");
  const DriveCycle* cruises = d.first(planning::Behaviour::cruise);
  ASSERT_NE(passes, nullptr);
  ASSERT_NE(cruises, nullptr);
  EXPECT_LT(passes->t_s, 0.5);
  for (double t_s = 0.0; t_s < 15.0; t_s += 0.1) EXPECT_GT(d.speed_at(t_s), 11.7) << t_s << " s";
  const auto offset_m = [&](double t_s) {
    return d.world.line.project(d.drive.trajectory.at(t_s).pose().position()).d_m;
  };
  EXPECT_NEAR(offset_m(5.5), 3.5, 0.3);  // beside it
  EXPECT_NEAR(offset_m(12.0), 0.0, 0.15);
}

TEST(ScenarioDrives, ParkedCarIsPassedAtTheClearanceThatIsAskedFor) {
  const Driven d = driven("parked_car");
  expect_arrives(d, 0.29);
  EXPECT_NE(d.first(planning::Behaviour::pass), nullptr);
}

TEST(ScenarioDrives, CarThatStopsAheadIsFollowedThroughout) {
  const Driven d = driven("slower_lead");
  expect_arrives(d, 5.0);
  int changes = 0;
  for (std::size_t i = 1; i < d.drive.cycles.size(); ++i) {
    changes += d.drive.cycles[i].behaviour != d.drive.cycles[i - 1].behaviour ? 1 : 0;
  }
  EXPECT_LE(changes, 3);  // cruise, follow, cruise, stop
}

TEST(ScenarioDrives, NarrowGapBetweenWallsIsDrivenThrough) {
  const Driven d = driven("narrow_gap");
  EXPECT_EQ(d.drive.verdict.outcome, Outcome::goal_reached) << d.drive.verdict.text;
  EXPECT_EQ(d.first(planning::Behaviour::emergency), nullptr);
}

TEST(ScenarioDrives, NarrowingIsPassedAfterWhoComesTheOtherWay) {
  const Driven d = driven("narrowing");
  expect_arrives(d, 0.29);
  EXPECT_NE(d.first(planning::Behaviour::pass), nullptr);
  // The two cars stand at x = 152 m; who comes the other way starts at x = 205 m with 7 m/s.
  EXPECT_GT(d.passes_x_at_s(150.0), (205.0 - 152.0) / 7.0 - 3.0);
}

TEST(ScenarioDrives, ClosedRoadIsLeftForAnotherRouteAfterTenSeconds) {
  const Driven d = driven("closed_road");
  expect_arrives(d, 0.29);
  const DriveCycle* blocked = d.first(planning::Behaviour::stop, "the road is blocked: barrier");
  ASSERT_NE(blocked, nullptr);
  EXPECT_THAT(
      blocked->reason,
      testing::HasSubstr("another route by lane 2200/0/-1 is taken, 832 m (+496 m, +43 s)"));
  EXPECT_TRUE(std::ranges::any_of(d.drive.events, [&](const DriveEvent& event) {
    return event.t_s == blocked->t_s && event.text == blocked->reason;
  }));
  for (double ago_s = 0.0; ago_s < 9.95; ago_s += 0.1) {
    EXPECT_LT(d.speed_at(blocked->t_s - ago_s), 0.3) << ago_s << " s before";
  }
  EXPECT_GT(d.speed_at(blocked->t_s - 10.5), 0.3) << "not for longer than it has to";
  ASSERT_EQ(d.drive.given_up.size(), 1U);
  EXPECT_EQ(d.world.road_map.lane(d.drive.given_up[0].route.legs.back().lane).name, "21/0/-1");
  // By the country road, which the first route did not use; the barrier is never passed.
  const auto& rows = d.drive.trajectory.points();
  EXPECT_TRUE(std::ranges::any_of(rows, [](const auto& row) { return row.y_m < 20.0; }));
  EXPECT_TRUE(std::ranges::none_of(
      rows, [](const auto& row) { return row.x_m > 320.0 && row.x_m < 474.0 && row.y_m > 195.0; }));
}

TEST(ScenarioDrives, RampIsLeftIntoAGap) {
  const Driven d = driven("on_ramp");
  expect_arrives(d, 1.0);
}

}  // namespace
}  // namespace roadbed::tools
