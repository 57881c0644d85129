#include "roadbed/tools/simulation/world.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

std::string junction() { return tests::bytes_of(tests::data_folder() / "junction.xml"); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

CommonRoadDrive problem_of(const std::string& bytes) {
  const tests::TemporaryFolder folder;
  return read_common_road_drive(folder.write("made.xml", bytes));
}

std::string refusal_of(const std::string& bytes) {
  return tests::refusal_of([&] { problem_of(bytes); });
}

/// A road eastwards that ends at `end_x_m`, the ego's centre in its middle at x = 5 m at a speed,
/// and a goal state.
std::string road_that_ends(double end_x_m, double speed_mps, const std::string& goal,
                           double half_width_m = 2.0) {
  const auto bound = [&](const char* name, double y_m) {
    return fmt::format(
        "<{0}><point><x>0</x><y>{1}</y></point><point><x>{2}</x><y>{1}</y></point></{0}>", name,
        y_m, end_x_m);
  };
  return "<?xml version=\"1.0\"?><commonRoad timeStepSize=\"0.1\" commonRoadVersion=\"2020a\" "
         "benchmarkID=\"ZAM_End-1_1_T-1\"><lanelet id=\"1\">" +
         bound("leftBound", half_width_m) + bound("rightBound", -half_width_m) +
         fmt::format(
             "<laneletType>urban</laneletType></lanelet><planningProblem id=\"9\">"
             "<initialState><position><point><x>5</x><y>0</y></point></position>"
             "<orientation><exact>0</exact></orientation><time><exact>0</exact></time>"
             "<velocity><exact>{}</exact></velocity></initialState><goalState>{}</goalState>"
             "</planningProblem></commonRoad>",
             speed_mps, goal);
}

std::string within_steps(int least, int most) {
  return fmt::format("<time><intervalStart>{}</intervalStart><intervalEnd>{}</intervalEnd></time>",
                     least, most);
}

TEST(CommonRoadWorld, DriveStopsBeforeTheRoadEndsWhateverTheGoal) {
  CommonRoadDrive problem = problem_of(road_that_ends(60.0, 10.0, within_steps(100, 110)));
  const Drive driven = drive(problem.scenario, problem.world);
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  const double front_x_m =
      driven.trajectory.points().back().x_m + problem.scenario.vehicle.front_m();
  EXPECT_LT(front_x_m, 60.0);
  EXPECT_GT(front_x_m, 40.0);
}

TEST(CommonRoadWorld, GoalThatIsReachedOffTheRoadDoesNotCount) {
  // 10.75 m from the front to the road's end; at 20 m/s nothing stops before.
  CommonRoadDrive problem = problem_of(road_that_ends(18.0, 20.0, within_steps(10, 12)));
  const Drive driven = drive(problem.scenario, problem.world);
  EXPECT_EQ(driven.verdict.outcome, Outcome::left_road) << driven.verdict.text;
  const auto& last = driven.trajectory.points().back();
  EXPECT_NEAR(driven.samples.back().off_road_m,
              last.x_m + geometry::VehicleShape{}.front_m() - 18.0, 5e-3);
  EXPECT_GT(driven.samples.back().off_road_m, 1.0);
}

/// At 18 m/s on a road of 20 m, so far to the left, and straight on again, after 2 s.
Drive driven_aside(double aside_m) {
  CommonRoadDrive problem = problem_of(road_that_ends(
      200.0, 18.0,
      fmt::format("<position><rectangle><length>20</length><width>2</width><orientation>0"
                  "</orientation><center><x>41</x><y>{}</y></center></rectangle></position>"
                  "<orientation><intervalStart>-0.15</intervalStart><intervalEnd>0.15"
                  "</intervalEnd></orientation>",
                  aside_m) +
          within_steps(19, 21),
      10.0));
  return drive(problem.scenario, problem.world);
}

double most_lateral_mps2(const Drive& driven) {
  double most = 0.0;
  for (const geometry::TrajectoryPoint& point : driven.trajectory.points()) {
    most = std::max(most, point.speed_mps * point.speed_mps * std::abs(point.curvature_per_m));
  }
  return most;
}

bool says(const Drive& driven, const std::string& text) {
  return std::ranges::any_of(driven.events, [&](const DriveEvent& event) {
    return event.text.find(text) != std::string::npos;
  });
}

TEST(CommonRoadWorld, GoalWithinUsualSteeringIsReachedWithinIt) {
  const Drive driven = driven_aside(4.5);
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  EXPECT_LE(most_lateral_mps2(driven), 3.95);
  EXPECT_FALSE(says(driven, "m/s² to the side"));
}

// 2 m farther, where no drive within 3.9 m/s² is found.
TEST(CommonRoadWorld, GoalBeyondUsualSteeringIsReachedAndSaidToBe) {
  const Drive driven = driven_aside(6.5);
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  EXPECT_GT(most_lateral_mps2(driven), 5.5);
  EXPECT_LE(most_lateral_mps2(driven), 10.05);
  EXPECT_TRUE(says(driven, "only with more than 3.9 m/s² to the side"));
}

TEST(CommonRoadWorld, StartIsTheRearAxleOfACentreThatTheFileGives) {
  CommonRoadDrive problem = problem_of(junction());
  const Eigen::Vector2d start = problem.world.road_map.to_source(problem.world.start.position());
  EXPECT_NEAR(start.x(), 5.0 - (0.5 * 4.508 - 0.8312829), 1e-9);
  EXPECT_NEAR(start.y(), 1.75, 1e-9);
  EXPECT_EQ(problem.scenario.start_speed_mps, 10.0);
}

/// The junction with one goal state in place of its own.
std::string junction_with_goal(const std::string& goal) {
  std::string bytes = junction();
  const std::size_t from = bytes.find("<goalState>"), to = bytes.rfind("</goalState>");
  return bytes.replace(from, to + 12 - from, "<goalState>" + goal + "</goalState>");
}

TEST(CommonRoadWorld, LinesLeadToEveryLaneUnderTheGoal) {
  const CommonRoadDrive problem = problem_of(junction_with_goal(
      "<position><rectangle><length>6</length><width>5</width><orientation>0</orientation><center>"
      "<x>42</x><y>0</y></center></rectangle></position>" +
      within_steps(20, 60)));
  const World& world = problem.world;
  std::vector<double> ends_y_m{world.line.at(world.line.goal_s_m()).in_map.y()};
  for (const auto& other : world.other_lines)
    ends_y_m.push_back(other.at(other.goal_s_m()).in_map.y());
  for (double& y_m : ends_y_m) y_m = world.road_map.to_source({0.0, y_m}).y();
  EXPECT_THAT(ends_y_m, testing::Contains(testing::DoubleNear(1.75, 0.3)));
  EXPECT_THAT(ends_y_m, testing::Contains(testing::DoubleNear(-1.75, 0.3)));
  EXPECT_EQ(world.other_stop_points.size(), world.other_lines.size());
  EXPECT_LE(world.other_lines.size(), 4u);
}

TEST(CommonRoadWorld, RecordedObstaclesAreThereAsLongAsTheirRecording) {
  CommonRoadDrive problem = problem_of(junction());
  ASSERT_EQ(problem.world.obstacles.size(), 2u + 6u);     // the last is an occupancy set of 6 steps
  EXPECT_TRUE(problem.world.obstacles[0].is_there(1e6));  // stands
  EXPECT_TRUE(problem.world.obstacles[1].is_there(3.0));  // 30 recorded steps
  EXPECT_FALSE(problem.world.obstacles[1].is_there(3.1));
}

TEST(CommonRoadWorld, GoalIsReachedInItsTimeAtTheSameBytesEveryTime) {
  CommonRoadDrive problem = problem_of(junction());
  const Drive first = drive(problem.scenario, problem.world);
  EXPECT_EQ(first.verdict.outcome, Outcome::goal_reached) << first.verdict.text;
  EXPECT_GE(first.verdict.at_s, 6.0 - 1e-9);
  EXPECT_LE(first.verdict.at_s, 15.0);
  const Drive second = drive(problem.scenario, problem.world);
  EXPECT_EQ(write_trajectory_csv(first.trajectory), write_trajectory_csv(second.trajectory));
}

/// When the front bumper passes the stop line at x = 50 m.
double passes_line_at_s(const Drive& drive) {
  for (const auto& row : drive.trajectory.points()) {
    if (row.x_m + geometry::VehicleShape{}.front_m() > 50.0) return row.t_s;
  }
  return 1e9;
}

TEST(CommonRoadWorld, RedLightIsWaitedAtAndGreenIsDrivenOnAt) {
  // On the lane of light 51: green until 1 s, yellow until 2 s, red and red with yellow until 9 s.
  const std::string on_right_lane =
      replaced(junction(), "<x>5</x><y>1.75</y>", "<x>5</x><y>-1.75</y>");
  CommonRoadDrive problem = problem_of(on_right_lane);
  const Drive waits = drive(problem.scenario, problem.world);
  EXPECT_EQ(waits.verdict.outcome, Outcome::goal_reached) << waits.verdict.text;
  EXPECT_GT(passes_line_at_s(waits), 9.0);
  EXPECT_LT(passes_line_at_s(waits), 11.0);
  EXPECT_TRUE(std::ranges::any_of(waits.cycles, [](const DriveCycle& cycle) {
    return cycle.behaviour == planning::Behaviour::yield &&
           cycle.reason.starts_with("light 51 is red");
  }));
  CommonRoadDrive dark =
      problem_of(replaced(on_right_lane, "<active>true</active>", "<active>false</active>"));
  EXPECT_LT(passes_line_at_s(drive(dark.scenario, dark.world)), 8.0);
}

TEST(CommonRoadWorld, SolutionHoldsEveryTimeStepOfTheCentre) {
  CommonRoadDrive problem = problem_of(junction());
  const Drive driven = drive(problem.scenario, problem.world);
  const std::string xml = solution_xml(problem, driven);
  EXPECT_THAT(xml, HasSubstr("benchmark_id=\"KS2:SM1:DEU_Junction-1_1_T-1:2020a\""));
  EXPECT_THAT(xml, HasSubstr("planningProblem=\"80\""));
  std::size_t states = 0;
  for (std::size_t at = 0; (at = xml.find("<ksState>", at)) != std::string::npos; ++at) ++states;
  EXPECT_EQ(states, static_cast<std::size_t>(std::lround(driven.verdict.at_s / 0.1)) + 1);
}

/// The ego's start of `road_that_ends`, as an obstacle.
std::string recording_at(double x_m, double length_m) {
  return fmt::format(
      "<dynamicObstacle id=\"42\"><type>car</type><shape><rectangle><length>{}</length><width>1.8"
      "</width></rectangle></shape><initialState><position><point><x>{}</x><y>0</y></point>"
      "</position><orientation><exact>0</exact></orientation><time><exact>0</exact></time>"
      "</initialState></dynamicObstacle>",
      length_m, x_m);
}

std::string with_obstacle(const std::string& road, const std::string& obstacle) {
  return replaced(road, "<planningProblem", obstacle + "<planningProblem");
}

TEST(CommonRoadWorld, EgosOwnRecordingIsNamedSoAndMayBeDropped) {
  const std::string road = road_that_ends(60.0, 10.0, within_steps(10, 20));
  const std::string own = with_obstacle(road, recording_at(5.02, 4.4));
  EXPECT_THAT(refusal_of(own), HasSubstr("obstacle 42 is 0.0 m from the ego"));
  EXPECT_THAT(refusal_of(own), HasSubstr("--drop-ego-recording"));
  const tests::TemporaryFolder folder;
  const auto dropped = [&](const std::string& bytes) {
    return read_common_road_drive(folder.write("made.xml", bytes), {.drops_ego_recording = true});
  };
  EXPECT_TRUE(dropped(own).world.obstacles.empty());
  EXPECT_EQ(dropped(with_obstacle(road, recording_at(30.0, 4.4))).world.obstacles.size(), 1u);
  for (const std::string& other : {recording_at(5.3, 4.4), recording_at(5.0, 7.0)}) {
    EXPECT_THAT(refusal_of(with_obstacle(road, other)),
                HasSubstr("obstacle 42 touches the ego at the start"));
    EXPECT_THROW(dropped(with_obstacle(road, other)), map::InputError);
  }
}

TEST(CommonRoadWorld, UnknownSpeedLimitIsWhatTheGoalsTimeAsks) {
  const auto limit_mps = [](int last) {
    const CommonRoadDrive problem = problem_of(road_that_ends(
        400.0, 14.0,
        "<position><rectangle><length>20</length><width>4</width><orientation>0</orientation>"
        "<center><x>205</x><y>0</y></center></rectangle></position>" +
            within_steps(30, last)));
    return problem.world.line.corridor_at(50.0).speed_limit_mps;
  };
  // From the rear axle to the goal's middle.
  const double way_m = 205.0 - 5.0 + 0.5 * 4.508 - 0.8312829;
  EXPECT_NEAR(limit_mps(90), 2.0 * way_m / 9.0 - 14.0, 1e-6);  // speeding up evenly
  EXPECT_NEAR(limit_mps(110), 2.0 * way_m / 11.0 - 14.0, 1e-6);
  EXPECT_NEAR(limit_mps(20 * 10), 14.0, 1e-9);  // time enough: that of the start
  EXPECT_NEAR(limit_mps(40), 1.1 * way_m / 4.0, 1e-6);
}

TEST(CommonRoadWorld, CollisionWithinATimeStepIsInTheSolution) {
  CommonRoadDrive problem = problem_of(
      with_obstacle(road_that_ends(60.0, 20.0, within_steps(10, 20)), recording_at(14.0, 4.4)));
  const Drive driven = drive(problem.scenario, problem.world);
  ASSERT_EQ(driven.verdict.outcome, Outcome::collision);
  const double steps = driven.verdict.at_s / 0.1;
  ASSERT_GT(std::abs(steps - std::round(steps)), 0.05);  // between two
  const std::string xml = solution_xml(problem, driven);
  EXPECT_THAT(xml, HasSubstr(fmt::format("<time>{}</time>", std::lround(std::ceil(steps)))));
}

TEST(CommonRoadWorld, WhatCannotBeDrivenIsRefused) {
  const std::string good = junction();
  const std::size_t from = good.find("<planningProblem"), to = good.find("</planningProblem>");
  EXPECT_THAT(refusal_of(good.substr(0, from) + good.substr(to + 18)),
              HasSubstr("no planning problem"));
  EXPECT_THAT(refusal_of(replaced(good, "<x>5</x><y>1.75</y>", "<x>5</x><y>500</y>")),
              HasSubstr("a start off the road"));
  EXPECT_THAT(refusal_of(replaced(good, "<velocity><exact>10</exact></velocity><yaw",
                                  "<velocity><exact>nan</exact></velocity><yaw")),
              HasSubstr("made.xml"));
  EXPECT_THAT(refusal_of(replaced(good, "lanelet ref=\"12\"", "lanelet ref=\"99\"")),
              HasSubstr("lanelet 99"));
  EXPECT_THAT(refusal_of(replaced(good, "timeStepSize=\"0.1\"", "timeStepSize=\"0\"")),
              HasSubstr("timeStepSize"));
  EXPECT_THAT(refusal_of(replaced(good, "timeStepSize=\"0.1\"", "timeStepSize=\"1e9\"")),
              HasSubstr("time steps of 1000000000"));
  for (const std::string speed : {"-5", "1e300"}) {
    EXPECT_THAT(refusal_of(replaced(good, "<velocity><exact>10</exact></velocity><yaw",
                                    "<velocity><exact>" + speed + "</exact></velocity><yaw")),
                HasSubstr("needs 0 to 100 m/s"));
  }
  const std::size_t second = good.find("<time><exact>2</exact></time>");
  const std::size_t state = good.rfind("<state>", second), next = good.find("<state>", second);
  EXPECT_THAT(refusal_of(good.substr(0, state) + good.substr(next)),
              HasSubstr("obstacle 72: time step 3 after 1"));
}

TEST(CommonRoadWorld, OccupanciesOutOfOrderOrWithoutAShapeAreRefused) {
  const auto refusal_with = [](const std::string& occupancies) {
    return refusal_of(with_obstacle(
        road_that_ends(60.0, 10.0, within_steps(10, 20)),
        replaced(recording_at(30.0, 4.4), "</dynamicObstacle>",
                 "<occupancySet>" + occupancies + "</occupancySet></dynamicObstacle>")));
  };
  const auto at_step = [](const std::string& shape, int step) {
    return fmt::format("<occupancy><shape>{}</shape><time><exact>{}</exact></time></occupancy>",
                       shape, step);
  };
  const std::string circle =
      "<circle><radius>1</radius><center><x>30</x><y>0</y></center></circle>";
  EXPECT_EQ(refusal_with(at_step(circle, 1) + at_step(circle, 2)), "accepted");
  EXPECT_THAT(refusal_with(at_step(circle, 3) + at_step(circle, 2)),
              HasSubstr("obstacle 42: an occupancy at time step 2 after 3"));
  EXPECT_THAT(refusal_with(at_step(circle, 1) + at_step("", 2)),
              HasSubstr("obstacle 42: an occupancy at time step 2 without a shape"));
}

TEST(CommonRoadWorld, VerdictSaysWhatTheGoalLacked) {
  const auto verdict_of = [](const std::string& asked) {
    CommonRoadDrive problem = problem_of(road_that_ends(
        100.0, 10.0,
        "<position><rectangle><length>10</length><width>4</width><orientation>0</orientation>"
        "<center><x>50</x><y>0</y></center></rectangle></position>" +
            asked + within_steps(30, 60)));
    return drive(problem.scenario, problem.world).verdict;
  };
  const DriveVerdict across = verdict_of(
      "<orientation><intervalStart>1.4</intervalStart><intervalEnd>1.7</intervalEnd></"
      "orientation>");
  EXPECT_EQ(across.outcome, Outcome::stopped);
  EXPECT_THAT(across.text, HasSubstr("at best only its heading was missed"));
  const DriveVerdict fast = verdict_of(
      "<velocity><intervalStart>80</intervalStart><intervalEnd>90</intervalEnd></velocity>");
  EXPECT_THAT(fast.text, HasSubstr("at best only its speed was missed"));
}

TEST(CommonRoadWorld, WithoutAGoalTheVehicleComesToRestAndSaysWhy) {
  std::string bytes = junction();
  const std::size_t from = bytes.find("<goalState>"), to = bytes.rfind("</goalState>");
  bytes.erase(from, to + 12 - from);
  CommonRoadDrive problem = problem_of(bytes);
  const Drive driven = drive(problem.scenario, problem.world);
  EXPECT_EQ(driven.verdict.outcome, Outcome::stopped);
  EXPECT_THAT(driven.verdict.text, HasSubstr("states no goal"));
}

}  // namespace
}  // namespace roadbed::tools
