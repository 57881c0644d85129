// Overtaking through the lane of those who come the other way: data/scenarios/overtake.json, and
// the same road with somebody who comes sooner, later, or much faster than allowed.
#include "roadbed/planning/maneuvers/overtaking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kMiddle_m = 0.0;  // y of the line between the two lanes; the own one is south

Scenario overtake() { return read_scenario(tests::data_folder() / "scenarios" / "overtake.json"); }

/// Poses westwards in the other lane.
ScenarioObstacle comes(const std::vector<std::pair<double, double>>& t_and_x) {
  ScriptedObstacle motion;
  for (const auto& [t_s, x_m] : t_and_x) {
    motion.poses.push_back({t_s, {x_m, 1.75, std::numbers::pi}});
  }
  return {.id = "comes", .motion = motion};
}

/// The lorry, and one who comes.
Scenario with(const ScenarioObstacle& other) {
  Scenario scenario = overtake();
  scenario.obstacles = {scenario.obstacles.front(), other};
  return scenario;
}

struct Passed {
  Drive drive;
  double clearance_m = 1e9;
  double begins_s = 1e9, ends_s = -1.0;  ///< the body is in the other lane
  double least_margin_s = 1e9;           ///< until one who comes would be met, while it is there

  bool waits() const { return begins_s > 8.0; }
};

Passed passed(const Scenario& scenario, const LoopOptions& options = {}) {
  World world = make_world(scenario);
  Passed result{.drive = drive(scenario, world, options)};
  for (const DriveSample& sample : result.drive.samples) {
    result.clearance_m = std::min(result.clearance_m, sample.clearance_m);
  }
  for (const auto& row : result.drive.trajectory.points()) {
    if (row.y_m + 0.5 * scenario.vehicle.width_m < kMiddle_m) continue;
    result.begins_s = std::min(result.begins_s, row.t_s);
    result.ends_s = std::max(result.ends_s, row.t_s);
    for (const planning::Obstacle& other : world.obstacles) {
      const auto at = other.motion.at(row.t_s);
      const Eigen::Vector2d place = world.road_map.to_source(at.pose().position());
      const double left_m = place.x() - 0.5 * other.length_m - row.x_m - scenario.vehicle.front_m();
      if (std::cos(at.heading_rad) > 0.0 || left_m < 0.0) continue;
      result.least_margin_s =
          std::min(result.least_margin_s, left_m / (row.speed_mps + at.speed_mps));
    }
  }
  return result;
}

void expect_safe(const Passed& passed) {
  EXPECT_EQ(passed.drive.verdict.outcome, Outcome::goal_reached) << passed.drive.verdict.text;
  EXPECT_GE(passed.clearance_m, 0.6);
  EXPECT_GE(passed.least_margin_s, 1.5);
  EXPECT_TRUE(std::ranges::none_of(passed.drive.cycles, [](const DriveCycle& cycle) {
    return cycle.behaviour == planning::Behaviour::emergency;
  }));
}

TEST(Overtaking, WaitsUntilThoseWhoComeLeaveRoom) {
  const Passed drive = passed(overtake());
  expect_safe(drive);
  // The third of those who come is beside the lorry after 22 s; behind it the road is free for
  // long.
  EXPECT_GT(drive.begins_s, 21.0);
  EXPECT_LT(drive.begins_s, 27.0);
  const auto& cycles = drive.drive.cycles;
  EXPECT_NE(cycles[100].reason.find("lorry is not overtaken: "), std::string::npos)
      << cycles[100].reason;
  EXPECT_NE(cycles[280].reason.find("overtakes lorry"), std::string::npos) << cycles[280].reason;
}

TEST(Overtaking, EveryGapIsEitherWaitedForOrEnough) {
  int waits = 0, goes = 0;
  for (double x_m = 260.0; x_m <= 740.0; x_m += 60.0) {
    SCOPED_TRACE(x_m);
    const Passed drive = passed(with(comes({{0.0, x_m}, {60.0, x_m - 900.0}})));
    expect_safe(drive);
    (drive.waits() ? waits : goes) += 1;
  }
  EXPECT_GE(waits, 3);
  EXPECT_GE(goes, 3);
}

TEST(Overtaking, IsGivenUpWhereSomebodyComesMuchFasterThanAllowed) {
  for (const double from_s : {1.0, 3.0}) {
    SCOPED_TRACE(from_s);
    Scenario scenario = with(comes({{0.0, 700.0},
                                    {from_s, 700.0 - 5.0 * from_s},
                                    {from_s + 20.0, 700.0 - 5.0 * from_s - 20.0 * 65.0}}));
    scenario.start_speed_mps = 7.0;
    const Passed drive = passed(scenario, {.predicts = false});
    expect_safe(drive);
    EXPECT_TRUE(std::ranges::any_of(drive.drive.cycles, [](const DriveCycle& cycle) {
      return cycle.reason == "falls back behind lorry again";
    }));
  }
}

// Brakes by 4 m/s², stands for 10 s, then drives as fast as one wants to.
TEST(Overtaking, WhoWaitsInTheLaneIsNotPassed) {
  Scenario scenario = overtake();
  scenario.duration_s = 40.0;
  ScriptedObstacle queue;
  const auto drives_to = [&](double t_s, double x_m) {
    queue.poses.push_back({t_s, {x_m, -1.75, 0.0}});
  };
  drives_to(0.0, 60.0);
  for (int k = 0; k <= 40; ++k) drives_to(1.0 + 0.1 * k, 76.0 + 1.6 * k - 0.02 * k * k);
  for (int k = 0; k <= 40; ++k) drives_to(15.0 + 0.1 * k, 108.0 + 0.02 * k * k);
  drives_to(60.0, 140.0 + 41.0 * 16.0);
  scenario.obstacles = {{.id = "queue", .motion = queue}};
  const Passed result = passed(scenario);
  EXPECT_LT(result.ends_s, 0.0) << "in the other lane from " << result.begins_s << " s";
  EXPECT_GT(result.clearance_m, 2.0);
}

TEST(Overtaking, WhoStandsForGoodIsPassedAfterThoseWhoCome) {
  Scenario scenario = overtake();
  const ScenarioPlace place{.text = "lane:1/0/-1@150", .pointer = "/test"};
  int waits = 0;
  for (const double aside_m : {0.0, -0.5}) {
    for (double x_m = 180.0; x_m <= 420.0; x_m += 60.0) {
      SCOPED_TRACE(testing::Message() << aside_m << " m aside, comes from " << x_m << " m");
      scenario.obstacles = {
          {.id = "parked", .motion = ParkedObstacle{ParkedObstacle::Beside{place, aside_m}}},
          comes({{0.0, x_m}, {60.0, x_m - 600.0}})};
      const Passed drive = passed(scenario);
      EXPECT_EQ(drive.drive.verdict.outcome, Outcome::goal_reached) << drive.drive.verdict.text;
      EXPECT_GE(drive.clearance_m, 0.29);
      EXPECT_GE(drive.least_margin_s, 1.5);
      for (const auto& row : drive.drive.trajectory.points()) {
        ASSERT_GE(row.acceleration_mps2, -2.5) << "after " << row.t_s << " s";
      }
      waits += std::ranges::any_of(drive.drive.cycles, [](const DriveCycle& cycle) {
        return cycle.behaviour == planning::Behaviour::yield &&
               cycle.reason.starts_with("parked is not passed: comes is oncoming");
      });
    }
  }
  EXPECT_GE(waits, 4);
}

TEST(Overtaking, UsesTheOtherLaneWhereTheMarkingBetweenMayBeCrossed) {
  const auto stretches = [](const std::string& file, const std::string& from,
                            const std::string& to) {
    const map::RoadMap road_map = map::load_map(tests::data_folder() / file);
    const auto route = planning::find_route(road_map, find_place(road_map, from).for_route(),
                                            find_place(road_map, to).for_route());
    if (!route.route) throw std::invalid_argument(route.reason);
    return oncoming_lane_segments(road_map, *route.route,
                                  planning::ReferenceLine::along(road_map, *route.route));
  };
  const auto country = stretches("country.xodr", "lane:1/0/-1@10", "lane:2/0/-1@100");
  ASSERT_EQ(country.size(), 2U);  // before and behind the junction of 40 m
  EXPECT_NEAR(country[0].from_s_m, 0.0, 0.1);
  EXPECT_NEAR(country[0].to_s_m, 890.0, 0.1);
  EXPECT_NEAR(country[1].from_s_m, 930.0, 0.1);
  EXPECT_NEAR(country[0].own_edge_m, 1.75, 0.01);
  EXPECT_NEAR(country[0].limit_mps, 80.0 / 3.6, 1e-9);
  EXPECT_EQ(country[0].side, 1.0);
  // A solid line, and two lanes of one direction.
  EXPECT_TRUE(stretches("town.xodr", "lane:5/0/-1@10", "lane:5/0/-1@300").empty());
  EXPECT_TRUE(stretches("town.xodr", "lane:31/0/-2@10", "lane:31/0/-2@90").empty());
}

}  // namespace
}  // namespace roadbed::tools
