#include "roadbed/tools/simulation/common_road_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "roadbed/map/input_error.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/closed_loop.h"
#include "roadbed/tools/simulation/solution_xml.h"
#include "roadbed/tools/support/trajectory_csv.h"

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
  try {
    problem_of(bytes);
  } catch (const map::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CommonRoadWorld, StartIsTheRearAxleOfACentreThatTheFileGives) {
  const CommonRoadDrive problem = problem_of(junction());
  const Eigen::Vector2d start = problem.world.road_map.to_source(problem.world.start.position());
  EXPECT_NEAR(start.x(), 5.0 - (0.5 * 4.508 - 0.8312829), 1e-9);
  EXPECT_NEAR(start.y(), 1.75, 1e-9);
  EXPECT_EQ(problem.scenario.start_speed_mps, 10.0);
}

TEST(CommonRoadWorld, RecordedObstaclesAreThereAsLongAsTheirRecording) {
  const CommonRoadDrive problem = problem_of(junction());
  ASSERT_EQ(problem.world.obstacles.size(), 3u);
  EXPECT_TRUE(problem.world.is_there(0, 1e6));  // stands
  EXPECT_TRUE(problem.world.is_there(1, 3.0));  // 30 recorded steps
  EXPECT_FALSE(problem.world.is_there(1, 3.1));
}

TEST(CommonRoadWorld, GoalIsReachedInItsTimeAtTheSameBytesEveryTime) {
  const CommonRoadDrive problem = problem_of(junction());
  const Drive first = drive(problem.scenario, problem.world);
  EXPECT_EQ(first.verdict.outcome, Outcome::goal_reached) << first.verdict.text;
  EXPECT_GE(first.verdict.at_s, 6.0 - 1e-9);
  EXPECT_LE(first.verdict.at_s, 15.0);
  const Drive second = drive(problem.scenario, problem.world);
  EXPECT_EQ(write_trajectory_csv(first.trajectory), write_trajectory_csv(second.trajectory));
}

TEST(CommonRoadWorld, SolutionHoldsEveryTimeStepOfTheCentre) {
  const CommonRoadDrive problem = problem_of(junction());
  const Drive driven = drive(problem.scenario, problem.world);
  const std::string xml = solution_xml(problem, driven);
  EXPECT_THAT(xml, HasSubstr("benchmark_id=\"KS2:SM1:DEU_Junction-1_1_T-1:2020a\""));
  EXPECT_THAT(xml, HasSubstr("planningProblem=\"80\""));
  std::size_t states = 0;
  for (std::size_t at = 0; (at = xml.find("<ksState>", at)) != std::string::npos; ++at) ++states;
  EXPECT_EQ(states, static_cast<std::size_t>(std::lround(driven.verdict.at_s / 0.1)) + 1);
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
}

TEST(CommonRoadWorld, WithoutAGoalTheVehicleComesToRestAndSaysWhy) {
  std::string bytes = junction();
  const std::size_t from = bytes.find("<goalState>"), to = bytes.rfind("</goalState>");
  bytes.erase(from, to + 12 - from);
  const CommonRoadDrive problem = problem_of(bytes);
  const Drive driven = drive(problem.scenario, problem.world);
  EXPECT_EQ(driven.verdict.outcome, Outcome::stopped);
  EXPECT_THAT(driven.verdict.text, HasSubstr("states no goal"));
}

}  // namespace
}  // namespace roadbed::tools
