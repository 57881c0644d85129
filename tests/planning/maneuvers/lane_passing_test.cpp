// Passing slower traffic in the next lane of a one-way road, in the closed loop: held to a plain
// argument about times and gaps.
#include "roadbed/planning/maneuvers/lane_passing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/planning/maneuvers/made_scenario.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kStart_m = 20.0, kGoal_m = 500.0, kGap_m = 35.0, kLead_m = 4.5;

enum class NextLane { free, none, taken, free_after_5_s, free_on_the_right };

struct PassingScene {
  double lead_mps, desired_mps;
  NextLane next_lane = NextLane::free;
  bool in_bend = false;
  bool may_cross = true;
  std::optional<double> fast_from_m = std::nullopt;     ///< a car at 20 m/s in the next lane
  std::optional<double> parked_at_m = std::nullopt;     ///< a car in the next lane
  std::optional<double> speeds_up_at_s = std::nullopt;  ///< the lead, to the desired speed
  std::optional<double> queue_at_m = std::nullopt;  ///< a car that stands in the own lane, known
  const char* change = "both";                      ///< which way the marking may be crossed
};

std::string lane(int id, bool may_cross, const char* change = "both") {
  return tests::made_lane(
      id, fmt::format(R"(<roadMark sOffset="0" type="{0}" color="white" laneChange="{1}"/>)",
                      may_cross ? "broken" : "solid", may_cross ? change : "none"));
}

/// One way, two lanes eastwards or one; in a bend of 200 m radius to the left.
std::filesystem::path map_of(const PassingScene& scene) {
  const bool has_two = scene.next_lane != NextLane::none;
  tests::MadeRoad road;
  road.id = "1";
  road.length_m = 800.0;
  road.type = R"(<type s="0" type="rural"><speed max="30" unit="m/s"/></type>)";
  road.lanes = tests::made_section(
      0.0, "",
      has_two ? lane(-1, scene.may_cross, scene.change) + lane(-2, false) : lane(-1, false));
  if (scene.in_bend) {
    road.plan_view =
        R"(<geometry s="0" x="0" y="0" hdg="0" length="800"><arc curvature="0.005"/></geometry>)";
  }
  return tests::made_file(
      fmt::format("passing_{}{}{}{}", has_two, scene.in_bend, scene.may_cross, scene.change), road);
}

ScenarioObstacle car(const std::string& id, const char* lane, double s_m,
                     std::vector<TimedSpeed> speeds) {
  if (speeds.front().speed_mps == 0.0 && speeds.size() == 1) {
    return {.id = id, .motion = ParkedObstacle{ParkedObstacle::Beside{place(lane, s_m)}}};
  }
  return {.id = id, .motion = TrafficObstacle{place(lane, s_m), {}, std::move(speeds)}};
}

struct PassingDrive {
  Drive drive;
  bool passed = false;             ///< the lead, by the end
  double others_brake_mps2 = 0.0;  ///< at most, of the last obstacle
  double beside_m = 0.0;           ///< the route's lane, in the end
  double clearance_m = 1e9;
};

PassingDrive drive_past(const PassingScene& scene) {
  const bool is_leftmost =
      scene.next_lane == NextLane::none || scene.next_lane == NextLane::free_on_the_right;
  const char* own = is_leftmost ? "0/-1" : "0/-2";
  Scenario scenario;
  scenario.file = "passing.json";
  scenario.map_file = map_of(scene);
  scenario.start = place(own, kStart_m);
  scenario.goal = place(own, kGoal_m);
  scenario.start_speed_mps = std::min(12.0, scene.desired_mps);
  scenario.duration_s = 80.0;
  scenario.options.desired_speed_mps = scene.desired_mps;
  const double lead_s_m = kStart_m + kGap_m, lead_mps = scene.lead_mps;
  scenario.obstacles = {car("lead", own, lead_s_m, {{0.0, lead_mps}})};
  if (scene.next_lane == NextLane::taken) {
    scenario.obstacles.push_back(car("beside", "0/-1", lead_s_m, {{0.0, lead_mps}}));
  }
  if (scene.next_lane == NextLane::free_after_5_s) {
    scenario.obstacles.push_back(
        car("beside", "0/-1", lead_s_m, {{0.0, lead_mps}, {5.0, lead_mps}, {12.0, 30.0}}));
  }
  if (scene.fast_from_m) {
    scenario.obstacles.push_back(car("fast", "0/-1", *scene.fast_from_m, {{0.0, 20.0}}));
  }
  if (scene.queue_at_m) {
    scenario.obstacles.push_back(car("queue", own, *scene.queue_at_m, {{0.0, 0.0}}));
  }
  if (scene.parked_at_m) {
    scenario.obstacles.push_back(car("parked", "0/-1", *scene.parked_at_m, {{0.0, 0.0}}));
  }
  if (scene.speeds_up_at_s) {
    const double at_s = *scene.speeds_up_at_s;
    scenario.obstacles.front() =
        car("lead", own, lead_s_m,
            {{0.0, lead_mps}, {at_s, lead_mps}, {at_s + 4.0, scene.desired_mps}});
  }
  World world = make_world(scenario);
  PassingDrive driven{.drive = drive(scenario, world, {.predicts = !scene.queue_at_m})};
  const geometry::TrajectoryPoint last = driven.drive.trajectory.points().back();
  const auto station = [&](const Eigen::Vector2d& in_map) {
    return world.line.project(in_map).s_m;
  };
  const auto own_s = station(world.road_map.to_map({last.x_m, last.y_m}));
  driven.beside_m = std::abs(world.line.project(world.road_map.to_map({last.x_m, last.y_m})).d_m);
  for (const DriveSample& sample : driven.drive.samples) {
    driven.clearance_m = std::min(driven.clearance_m, sample.clearance_m);
  }
  const auto& lead = world.obstacles.front().motion;
  driven.passed = own_s > station(lead.at(last.t_s).pose().position());
  const geometry::Trajectory& other = world.obstacles.back().motion;
  for (double t_s = 0.5; t_s < last.t_s; t_s += 0.1) {
    if (station(other.at(t_s).pose().position()) > 700.0) break;  // it rests at the road's end
    driven.others_brake_mps2 = std::max(
        driven.others_brake_mps2, (other.at(t_s - 0.5).speed_mps - other.at(t_s).speed_mps) / 0.5);
  }
  return driven;
}

/// Time that passing saves up to the goal, and whether there is room for it: closing up, coming
/// past with 20 m to spare, and 8 s for two changes of lanes.
double saved_s(const PassingScene& scene) {
  const double way_m = kGoal_m - kStart_m;
  return (way_m - kGap_m) / std::max(0.1, scene.lead_mps) - way_m / scene.desired_mps;
}
bool has_room(const PassingScene& scene) {
  const double faster_mps = scene.desired_mps - scene.lead_mps;
  if (faster_mps <= 0.5) return false;
  const double passes_s = (kGap_m + kLead_m + 20.0) / faster_mps + 8.0;
  return passes_s * scene.desired_mps < kGoal_m - kStart_m;
}

std::string words(const PassingScene& scene) {
  return fmt::format("lead {} m/s, desired {} m/s, next lane {}{}", scene.lead_mps,
                     scene.desired_mps, static_cast<int>(scene.next_lane),
                     scene.in_bend ? ", bend" : "");
}

TEST(LanePassing, PassesWhereFiveSecondsAreGainedAndFollowsElsewhere) {
  const bool is_short = std::getenv("ROADBED_ROUTES") != nullptr;  // ten times slower, sanitized
  int passes = 0, follows = 0;
  for (const NextLane next_lane : {NextLane::free, NextLane::none, NextLane::taken,
                                   NextLane::free_after_5_s, NextLane::free_on_the_right}) {
    for (const double lead_mps : {0.0, 1.0, 4.0, 8.0, 10.0, 16.0}) {
      for (const double desired_mps : {8.0, 12.0, 25.0}) {
        for (const bool in_bend : {false, true}) {
          if (in_bend && desired_mps != 12.0) continue;
          if (is_short && (in_bend || desired_mps != 12.0)) continue;
          const PassingScene scene{lead_mps, desired_mps, next_lane, in_bend};
          SCOPED_TRACE(words(scene));
          const PassingDrive driven = drive_past(scene);
          EXPECT_NE(driven.drive.verdict.outcome, Outcome::collision) << driven.drive.verdict.text;
          const bool is_open = next_lane == NextLane::free ||
                               (next_lane == NextLane::free_after_5_s && lead_mps > 0.0);
          const bool must = is_open && saved_s(scene) >= 5.0 && has_room(scene);
          const bool is_closed = next_lane == NextLane::none || next_lane == NextLane::taken ||
                                 (next_lane == NextLane::free_on_the_right && lead_mps > 0.0);
          const bool may_not = is_closed || saved_s(scene) < 3.0;
          if (next_lane == NextLane::free_after_5_s && must) {
            EXPECT_EQ(driven.drive.verdict.outcome, Outcome::goal_reached);
          } else if (must) {
            EXPECT_TRUE(driven.passed);
          }
          EXPECT_FALSE(may_not && driven.passed);
          passes += driven.passed ? 1 : 0;
          follows += driven.passed ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GE(passes, is_short ? 5 : 20);
  EXPECT_GE(follows, is_short ? 10 : 40);
}

TEST(LanePassing, SaysWhoIsInTheWay) {
  const auto reasons = [](const PassingScene& scene) {
    std::string all;
    for (const DriveCycle& cycle : drive_past(scene).drive.cycles) all += cycle.reason + "\n";
    return all;
  };
  EXPECT_NE(reasons({4.0, 12.0}).find("passes lead"), std::string::npos);
  EXPECT_NE(reasons({4.0, 12.0, NextLane::taken}).find("lead is not passed: beside is "),
            std::string::npos);
  EXPECT_NE(reasons({4.0, 12.0, NextLane::free, false, false})
                .find("lead is not passed: the marking may not be crossed here"),
            std::string::npos);
  PassingScene one_way{4.0, 12.0};
  for (const char* change : {"increase", "decrease"}) {
    one_way.change = change;
    const std::string why = reasons(one_way);
    EXPECT_EQ(why.find("passes lead"), std::string::npos) << change;
    EXPECT_NE(why.find("the marking may not be crossed"), std::string::npos) << change;
  }
  EXPECT_NE(reasons({4.0, 12.0, NextLane::free_on_the_right})
                .find("lead is not passed: there is no lane to its left, and nobody is passed on "
                      "the right"),
            std::string::npos);
}

TEST(LanePassing, AQueueIsPassedAsAWholeOrNotAtAll) {
  const auto passes = [](double lead_mps, double queue_at_m) {
    PassingScene scene{lead_mps, 12.0};
    scene.queue_at_m = queue_at_m;
    const PassingDrive driven = drive_past(scene);
    return std::ranges::any_of(driven.drive.cycles, [](const DriveCycle& cycle) {
      return cycle.t_s < 5.0 && cycle.reason.find("passes lead") != std::string::npos;
    });
  };
  EXPECT_TRUE(passes(3.0, 110.0));   // there is room before the goal to be back
  EXPECT_FALSE(passes(3.0, 450.0));  // the lead is about to join it
  EXPECT_TRUE(passes(6.0, 450.0));   // who drives does not queue
}

TEST(LanePassing, NobodyBehindHasToBrakeHard) {
  int waits = 0;
  for (const double from_m : {0.0, 5.0, 10.0, 22.0}) {
    SCOPED_TRACE(from_m);
    PassingScene scene{4.0, 12.0};
    scene.fast_from_m = from_m;
    const PassingDrive driven = drive_past(scene);
    EXPECT_TRUE(driven.passed);
    EXPECT_LT(driven.others_brake_mps2, 2.3);
    waits += std::ranges::any_of(driven.drive.cycles,
                                 [](const DriveCycle& cycle) {
                                   return cycle.reason.find("fast") != std::string::npos;
                                 })
                 ? 1
                 : 0;
  }
  EXPECT_GE(waits, 2);
}

TEST(LanePassing, FallsBackBehindALeadThatSpeedsUpMeanwhile) {
  for (const double at_s : {1.0, 2.0, 3.0, 4.0}) {
    SCOPED_TRACE(at_s);
    PassingScene scene{4.0, 12.0};
    scene.speeds_up_at_s = at_s;
    const PassingDrive driven = drive_past(scene);
    EXPECT_EQ(driven.drive.verdict.outcome, Outcome::goal_reached) << driven.drive.verdict.text;
    EXPECT_LT(driven.beside_m, 0.5);
    EXPECT_GT(driven.clearance_m, 1.2);
  }
}

TEST(LanePassing, CarsParkedInTheNextLaneAreInTheWay) {
  for (const double at_m : {60.0, 75.0, 90.0, 110.0}) {
    SCOPED_TRACE(at_m);
    PassingScene scene{4.0, 12.0};
    scene.parked_at_m = at_m;
    const PassingDrive driven = drive_past(scene);
    EXPECT_EQ(driven.drive.verdict.outcome, Outcome::goal_reached) << driven.drive.verdict.text;
    EXPECT_GT(driven.clearance_m, 1.2);
  }
}

TEST(LanePassing, IsSmooth) {
  const Drive drive = drive_past({4.0, 12.0}).drive;
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached);
  double hardest_mps2 = 0.0, clearance_m = 1e9;
  for (const auto& row : drive.trajectory.points()) {
    hardest_mps2 = std::max(hardest_mps2, -row.acceleration_mps2);
  }
  for (const DriveSample& sample : drive.samples) {
    clearance_m = std::min(clearance_m, sample.clearance_m);
  }
  EXPECT_LT(hardest_mps2, 1.7);  // what the stop at the goal takes
  EXPECT_GT(clearance_m, 1.2);
}

TEST(LanePassing, LetsACarByAndThenPassesTheLorry) {
  const Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "pass_lorry.json");
  World world = make_world(scenario);
  const Drive drive = simulation::drive(scenario, world);
  EXPECT_EQ(drive.verdict.outcome, Outcome::goal_reached) << drive.verdict.text;
  std::vector<std::string> reasons;
  for (const DriveCycle& cycle : drive.cycles) {
    if (cycle.reason.find("beside comes up behind in the next lane") != std::string::npos) {
      if (reasons.empty()) reasons.push_back("waits");
    } else if (cycle.reason == "passes lorry" && !reasons.empty() && reasons.back() == "waits") {
      reasons.push_back("passes");
    }
  }
  EXPECT_EQ(reasons, (std::vector<std::string>{"waits", "passes"}));
  for (const DriveSample& sample : drive.samples) EXPECT_GT(sample.clearance_m, 1.0);
}

TEST(LanePassing, LanesAreThoseOnTheSideOnWhichOnePasses) {
  const map::RoadMap road_map = map::load_map(map_of({4.0, 12.0}));
  const auto route =
      planning::find_route(road_map, find_place(road_map, "lane:1/0/-2@20").for_route(),
                           find_place(road_map, "lane:1/0/-2@500").for_route());
  ASSERT_TRUE(route.route);
  const auto lanes = planning::passing_lanes(
      road_map, *route.route, planning::ReferenceLine::along(road_map, *route.route));
  ASSERT_EQ(lanes.size(), 1U);
  EXPECT_NEAR(lanes[0].offset_m, 3.5, 0.01);
  EXPECT_NEAR(lanes[0].from_s_m, 0.0, 0.1);
  EXPECT_NEAR(lanes[0].to_s_m, 480.0, 0.1);
  ASSERT_EQ(lanes[0].change_windows.size(), 1U);
  EXPECT_NEAR(lanes[0].change_windows[0].to_s_m, 480.0, 0.1);
  const auto left =
      planning::find_route(road_map, find_place(road_map, "lane:1/0/-1@20").for_route(),
                           find_place(road_map, "lane:1/0/-1@500").for_route());
  EXPECT_TRUE(planning::passing_lanes(road_map, *left.route,
                                      planning::ReferenceLine::along(road_map, *left.route))
                  .empty());
}

}  // namespace
}  // namespace roadbed::tools
