// Merging where a lane ends, in the closed loop: held to a plain argument about times and gaps.
#include "roadbed/planning/maneuvers/merging.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "roadbed/tests/planning/maneuvers/made_scenario.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kMergingStart_m = 220.0, kOwnLaneEnds_m = 500.0,
                 kMergingGoal_m = 350.0;  // of the goal: beyond that
/// Where the middle of a change may be: its ends keep to where both lanes are.
constexpr double kFirstChange_m = 250.0, kLastChange_m = 470.0;

/// The ego's lane ends after 300 m; cars drive in the next one at one speed, at one gap.
struct MergingScene {
  double own_mps = 15.0, others_mps = 15.0;
  double gap_m = 0.0;      ///< bumper to bumper; 0: the road is free
  double first_m = 370.0;  ///< station of the first one
  int cars = 40;
  int without = -1;  ///< this one is missing
};

std::filesystem::path map_file() {
  const auto lane = [](int id, int next) {
    return tests::made_lane(
        id, fmt::format(R"(<link>{}</link>)",
                        next ? fmt::format(R"(<successor id="{}"/>)", next) : "") +
                R"(<roadMark sOffset="0" type="broken" color="white" laneChange="both"/>)");
  };
  tests::MadeRoad road;
  road.id = "1";
  road.length_m = 1500.0;
  road.type = R"(<type s="0" type="rural"><speed max="30" unit="m/s"/></type>)";
  road.lanes = tests::made_section(0.0, "", lane(-1, -1) + lane(-2, 0)) +
               tests::made_section(kOwnLaneEnds_m, "",
                                   tests::made_lane(-1, R"(<link><predecessor id="-1"/></link>)"));
  return tests::made_file("merging", road);
}

ScenarioPlace place_in_next_lane(double x_m) {
  return x_m < kOwnLaneEnds_m ? place("0/-1", x_m) : place("1/-1", x_m - kOwnLaneEnds_m);
}

Scenario scenario_of(const MergingScene& scene) {
  Scenario scenario;
  scenario.file = "merging.json";
  scenario.map_file = map_file();
  scenario.start = place("0/-2", kMergingStart_m);
  scenario.goal = place("1/-1", kMergingGoal_m);
  scenario.start_speed_mps = scene.own_mps;
  scenario.duration_s = 60.0;
  scenario.options.desired_speed_mps = std::max(8.0, scene.own_mps);
  for (int i = 0; i < (scene.gap_m > 0.0 ? scene.cars : 0); ++i) {
    const double s_m = scene.first_m - i * (scene.gap_m + kCar_m);
    if (s_m < 5.0) break;
    if (i == scene.without) continue;
    scenario.obstacles.push_back(
        {.id = fmt::format("car {}", i),
         .length_m = kCar_m,
         .motion = TrafficObstacle{place_in_next_lane(s_m), {}, {{0.0, scene.others_mps}}}});
  }
  return scenario;
}

struct MergingDrive {
  Drive drive;
  std::optional<std::size_t> ahead = {}, behind = {};  ///< in whose gap it has merged
  double others_brake_mps2 = 0.0, own_brake_mps2 = 0.0, clearance_m = 1e9, merged_at_s = 0.0;
  double least_mps = 1e9, merged_at_m = 0.0;
};

MergingDrive drive_in(const Scenario& scenario, World& world) {
  MergingDrive driven{.drive = drive(scenario, world)};
  for (const DriveSample& sample : driven.drive.samples) {
    driven.clearance_m = std::min(driven.clearance_m, sample.clearance_m);
  }
  for (const auto& row : driven.drive.trajectory.points()) {
    driven.own_brake_mps2 = std::max(driven.own_brake_mps2, -row.acceleration_mps2);
    if (row.y_m < -3.0) driven.least_mps = std::min(driven.least_mps, row.speed_mps);
    if (driven.merged_at_s > 0.0 || row.y_m < -2.2) continue;
    driven.merged_at_s = row.t_s;
    driven.merged_at_m = row.x_m;
    double ahead_m = 1e9, behind_m = -1e9;
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      const double at_m = world.obstacles[i].motion.at(row.t_s).x_m - row.x_m;
      if (at_m > 0 && at_m < ahead_m) ahead_m = at_m, driven.ahead = i;
      if (at_m <= 0 && at_m > behind_m) behind_m = at_m, driven.behind = i;
    }
  }
  for (std::size_t i = driven.behind.value_or(99); i < world.obstacles.size(); ++i) {
    const planning::Obstacle& other = world.obstacles[i];
    for (double t_s = driven.merged_at_s - 1.5; t_s < driven.merged_at_s + 8.0; t_s += 0.1) {
      if (other.motion.at(t_s).x_m > 1400.0) break;
      driven.others_brake_mps2 =
          std::max(driven.others_brake_mps2,
                   (other.motion.at(t_s - 0.5).speed_mps - other.motion.at(t_s).speed_mps) / 0.5);
    }
  }
  return driven;
}

MergingDrive drive_in(const MergingScene& scene) {
  const Scenario scenario = scenario_of(scene);
  World world = make_world(scenario);
  return drive_in(scenario, world);
}

/// Follows an intruder of constant speed by the simulation's car following, in small steps.
double hardest_braking_mps2(double gap_m, double speed_mps, double intruder_mps) {
  double hardest = 0.0;
  for (double t_s = 0.0; t_s < 6.0; t_s += 0.02) {
    const double wanted_m =
        2.0 + std::max(0.0, 1.2 * speed_mps + speed_mps * (speed_mps - intruder_mps) /
                                                  (2.0 * std::sqrt(1.5 * 2.0)));
    const double z = wanted_m / std::max(0.01, gap_m);
    const double braking = z < 1.0 ? 0.0 : 1.5 * (z * z - 1.0);
    hardest = std::max(hardest, braking);
    speed_mps = std::max(0.0, speed_mps - 0.02 * braking);
    gap_m += 0.02 * (intruder_mps - speed_mps);
  }
  return hardest;
}

/// Whether a place in the next lane has much room to both sides: 2 m and 0.8 s behind who is ahead,
/// and the one behind brakes by 1.5 m/s² at most.
bool has_room(const MergingScene& scene, double t_s, double front_m, double speed_mps) {
  const double spacing_m = scene.gap_m + kCar_m;
  const double first_at_m = scene.first_m + scene.others_mps * t_s;
  const double number = std::ceil((first_at_m - front_m) / spacing_m) - 1.0;  // who is ahead
  if (number < 0.0 || scene.first_m - (number + 1.0) * spacing_m < 5.0) return false;
  const double ahead_m = first_at_m - number * spacing_m - 0.5 * kCar_m - front_m;
  const double behind_m = scene.gap_m - ahead_m - 4.508;
  if (ahead_m < 2.0 + 0.8 * scene.others_mps || behind_m < 0.0) return false;
  if (speed_mps > scene.others_mps + 0.3) return false;
  return hardest_braking_mps2(behind_m, scene.others_mps, speed_mps) < 1.5;
}

/// Whether some drive with two accelerations comes to a place with much room, where lanes may be
/// changed.
bool has_easy_gap(const MergingScene& scene) {
  const double most_mps = std::max(8.0, scene.own_mps);
  for (double first_mps2 = -1.2; first_mps2 < 0.75; first_mps2 += 0.1) {
    for (double until_s = 0.0; until_s < 8.0; until_s += 0.5) {
      double s_m = kMergingStart_m + 3.68, speed_mps = scene.own_mps;
      for (double t_s = 0.0; s_m < kLastChange_m && t_s < 60.0; t_s += 0.05) {
        const double wanted_mps = std::min(most_mps, scene.others_mps);
        const double back_mps2 = std::clamp((wanted_mps - speed_mps) / 0.5, -1.0, 0.7);
        speed_mps += 0.05 * (t_s < until_s ? first_mps2 : back_mps2);
        speed_mps = std::clamp(speed_mps, 1.0, most_mps);
        s_m += 0.05 * speed_mps;
        if (s_m > kFirstChange_m && has_room(scene, t_s, s_m, speed_mps)) return true;
      }
    }
  }
  return false;
}

TEST(Merging, TakesGapsThatAreEasyWithoutAStop) {
  const bool is_short = std::getenv("ROADBED_ROUTES") != nullptr;  // ten times slower, sanitized
  int merges = 0;
  for (const double others_mps : {2.0, 5.0, 10.0, 15.0, 25.0}) {
    for (const double faster_mps : {-5.0, 0.0, 5.0}) {
      for (const double gap_m : {4.0, 20.0, 30.0, 40.0, 60.0}) {
        if (gap_m < 10.0 && others_mps > 5.0) continue;  // nobody drives like that
        const MergingScene scene{others_mps + faster_mps, others_mps, gap_m};
        if (scene.own_mps < 3.0 || scene.own_mps > 25.0) continue;
        if (is_short && (others_mps != 15.0 || faster_mps != 0.0)) continue;
        SCOPED_TRACE(
            fmt::format("own {} m/s, others {} m/s, gap {} m", scene.own_mps, others_mps, gap_m));
        const MergingDrive driven = drive_in(scene);
        EXPECT_NE(driven.drive.verdict.outcome, Outcome::collision) << driven.drive.verdict.text;
        EXPECT_GT(driven.clearance_m, 0.29);
        EXPECT_LT(driven.others_brake_mps2, 2.5);
        EXPECT_LT(driven.own_brake_mps2, 3.5);
        if (has_easy_gap(scene)) {
          EXPECT_TRUE(driven.ahead && driven.behind);
          EXPECT_GT(driven.least_mps, 1.0);  // in its own lane: it did not have to wait
          ++merges;
        }
      }
    }
  }
  EXPECT_GE(merges, is_short ? 2 : 25);
}

/// Cars of 12 m/s with 17 m between them leave one gap, which comes by earlier or later: the lane
/// may be changed from x = 220 m to 500 m.
TEST(Merging, IsWhereTheGapIs) {
  double last_m = 0.0;
  for (const int without : {7, 10, 13}) {
    const MergingDrive driven =
        drive_in({.own_mps = 10.0, .others_mps = 12.0, .gap_m = 17.0, .without = without});
    SCOPED_TRACE(fmt::format("without car {}, merged at {} m", without, driven.merged_at_m));
    EXPECT_EQ(driven.ahead, without - 1);  // indices up to there are those of the names
    EXPECT_GT(driven.least_mps, 1.0);
    EXPECT_LT(driven.others_brake_mps2, 2.5);
    EXPECT_GT(driven.merged_at_m, last_m + 20.0);
    last_m = driven.merged_at_m;
  }
  EXPECT_GT(last_m, 365.0);  // beyond the middle
}

TEST(Merging, NobodyInTheNextLaneIsNoReasonToSlowDown) {
  for (const double own_mps : {5.0, 15.0, 25.0}) {
    const MergingDrive driven = drive_in({own_mps, 0.0, 0.0});
    EXPECT_GT(driven.merged_at_s, 0.0);
    EXPECT_GT(driven.least_mps, own_mps - 0.1);
  }
}

// Far ahead when it is merged behind, and much slower: closed up to as to anybody.
TEST(Merging, WhoIsMergedBehindIsKeptFromWhenClosedUpTo) {
  const MergingDrive driven =
      drive_in({.own_mps = 16.0, .others_mps = 7.5, .gap_m = 500.0, .first_m = 480.0, .cars = 1});
  EXPECT_EQ(driven.drive.verdict.outcome, Outcome::goal_reached) << driven.drive.verdict.text;
  EXPECT_GT(driven.clearance_m, 12.0);
  EXPECT_LT(driven.own_brake_mps2, 2.2);
}

TEST(Merging, ThereIsAnAnswerAtAnySpeedAndAtAnyDistance) {
  const std::vector<planning::MergeMover> others{{0, -20.0, 2.25, 10.0}, {1, 40.0, 2.25, 0.0}};
  for (const double speed_mps : {0.0, 3.0, 10.0, 40.0}) {
    for (const double free_mps : {0.0, 0.5, 6.0, 30.0}) {
      for (const double to_enter_m : {-3.0, 0.0, 0.5, 20.0, 150.0}) {
        const planning::MergeGap gap = planning::choose_merge_gap(
            {.to_enter_m = {to_enter_m}, .speed_mps = speed_mps, .free_mps = free_mps}, others, {});
        EXPECT_TRUE(std::isfinite(gap.after_s) && gap.after_s >= 0.0);
        EXPECT_TRUE(std::isfinite(gap.missing_m) && gap.missing_m >= 0.0);
        EXPECT_GE(gap.speed_mps, 0.0);
        EXPECT_TRUE(gap.ahead || gap.behind);
      }
    }
  }
}

TEST(Merging, SaysWhoIsInTheWayAndHowManyMetresAreMissing) {
  const MergingDrive driven = drive_in({15.0, 15.0, 10.0});
  const auto says = [&](const std::string& part) {
    return std::ranges::any_of(driven.drive.cycles, [&](const DriveCycle& cycle) {
      return cycle.reason.find(part) != std::string::npos;
    });
  };
  EXPECT_TRUE(says("no gap to merge into: "));
  EXPECT_TRUE(says(" m are missing behind car "));
  EXPECT_TRUE(says("and before car "));
  const MergingDrive easy = drive_in({20.0, 15.0, 60.0});
  EXPECT_TRUE(std::ranges::any_of(easy.drive.cycles, [](const DriveCycle& cycle) {
    return cycle.reason.find("merges behind car ") == 0;
  }));
}

TEST(Merging, RoomBehindIsWhatAFollowerStopsClosingInBy2MetresPerSecondSquared) {
  for (const double own_mps : {5.0, 10.0, 20.0}) {
    for (const double behind_mps : {5.0, 12.0, 20.0}) {
      const double room_m = planning::room_behind_m(own_mps, behind_mps);
      if (behind_mps < own_mps) continue;  // it falls back by itself
      EXPECT_NEAR(hardest_braking_mps2(room_m, behind_mps, own_mps), 2.0, 0.02);
    }
  }
}

/// Vehicles that pass the ego's front beyond a station, until it has merged.
int passed_beyond(double from_m, const MergingDrive& driven, const World& world) {
  int count = 0;
  for (const planning::Obstacle& other : world.obstacles) {
    const auto ahead_m = [&](double t_s) {
      return other.motion.at(t_s).x_m - driven.drive.trajectory.at(t_s).x_m;
    };
    double t_s = 0.0;
    while (driven.drive.trajectory.at(t_s).x_m < from_m && t_s < driven.merged_at_s) t_s += 0.1;
    count += ahead_m(t_s) < 0.0 && ahead_m(driven.merged_at_s) > 0.0;
  }
  return count;
}

/// The queue reaches from beyond the lane's end to far behind: in such a one nobody found a gap.
TEST(Merging, InADenseQueueOneIsLetInAtTheEndOfTheLane) {
  for (const double others_mps : {2.0, 4.0, 6.0, 8.0}) {
    for (const double headway_s : {1.3, 2.0, 3.0}) {
      const MergingScene scene{.own_mps = others_mps,
                               .others_mps = others_mps,
                               .gap_m = std::max(3.0, others_mps * headway_s - kCar_m),
                               .first_m = 560.0,
                               .cars = 60};
      SCOPED_TRACE(fmt::format("others {} m/s, gap {} m", others_mps, scene.gap_m));
      Scenario scenario = scenario_of(scene);
      scenario.duration_s = 80.0;
      World world = make_world(scenario);
      const MergingDrive driven = drive_in(scenario, world);
      EXPECT_NE(driven.drive.verdict.outcome, Outcome::collision) << driven.drive.verdict.text;
      EXPECT_GT(driven.clearance_m, 0.29);
      EXPECT_LT(driven.others_brake_mps2, 2.5);
      EXPECT_TRUE(driven.ahead && driven.behind);
      EXPECT_LE(passed_beyond(470.0, driven, world), 3);
    }
  }
}

TEST(Merging, LinesChangeAtBothEndsOfWhatTheMapLeaves) {
  const World world = make_world(scenario_of({15.0, 15.0, 0.0}));
  const auto places = planning::merge_places(world.road_map, world.route, world.line);
  ASSERT_EQ(places.size(), 1U);
  const auto lines =
      planning::merge_lines(world.road_map, world.route, places[0], world.line_options);
  ASSERT_TRUE(lines);
  const auto y_m = [](const planning::ReferenceLine& line, double x_m) {
    return line.at(line.project({x_m, -3.5}).s_m).in_map.y();
  };
  EXPECT_NEAR(y_m(lines->own_lane, 465.0), -5.25, 0.05);  // 30 m before the lane's end
  EXPECT_NEAR(y_m(lines->own_lane, 485.0), -3.5, 0.1);
  EXPECT_NEAR(y_m(lines->own_lane, 500.0), -1.75, 0.05);
  const double long_m = 3.5 * 15.0;
  EXPECT_NEAR(y_m(lines->next_lane, kMergingStart_m), -5.25, 0.05);
  EXPECT_NEAR(y_m(lines->next_lane, kMergingStart_m + 0.5 * long_m), -3.5, 0.1);
  EXPECT_NEAR(y_m(lines->next_lane, kMergingStart_m + long_m), -1.75, 0.05);
  EXPECT_NEAR(places[0].lane.at(lines->hold_m).x(), 485.0 - 0.115 * 30.0, 1.5);
}

TEST(Merging, PlaceIsWhereTheBodyComesIntoTheWay) {
  MergingScene scene{15.0, 15.0, 0.0};
  const World world = make_world(scenario_of(scene));
  const auto places = planning::merge_places(world.road_map, world.route, world.line);
  ASSERT_EQ(places.size(), 1U);
  const auto y_m = [&](double s_m) { return world.line.at(s_m).in_map.y(); };
  EXPECT_NEAR(y_m(places[0].hold_s_m), -1.75 - 2.6, 0.1);
  EXPECT_NEAR(y_m(places[0].enter_s_m), -1.75 - 2.0, 0.1);
  EXPECT_NEAR(y_m(places[0].out_s_m), -1.75 - 0.5, 0.1);
  EXPECT_NEAR(places[0].lane.at(places[0].enter_m).x(),
              world.line.at(places[0].enter_s_m).in_map.x(), 0.01);
}

}  // namespace
}  // namespace roadbed::tools
