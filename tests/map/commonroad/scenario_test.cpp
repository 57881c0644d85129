#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map::commonroad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Scenario junction() {
  return parse_scenario(read_file(tests::data_folder() / "junction.xml"), "junction.xml");
}

Scenario parse(const std::string& body) {
  return parse_scenario(
      "<commonRoad commonRoadVersion=\"2020a\" timeStepSize=\"0.1\">" + body + "</commonRoad>",
      "made.xml");
}

std::string exact(const std::string& name, const std::string& value) {
  return "<" + name + "><exact>" + value + "</exact></" + name + ">";
}

const std::string kBox = "<shape><rectangle><length>4</length><width>2</width></rectangle></shape>";
const std::string kStart = "<initialState><position><point><x>1</x><y>2</y></point></position>" +
                           exact("orientation", "0.5") + exact("time", "0") + "</initialState>";

TEST(CommonRoadScenario, HeaderSaysTimeStepAndTags) {
  const Scenario scenario = junction();
  EXPECT_EQ(scenario.time_step_s, 0.1);
  EXPECT_EQ(scenario.benchmark_id, "DEU_Junction-1_1_T-1");
  EXPECT_THAT(scenario.tags, ElementsAre("urban", "intersection"));
}

TEST(CommonRoadScenario, TrajectoriesAreStatesPerTimeStep) {
  const Scenario scenario = junction();
  ASSERT_THAT(scenario.obstacles, SizeIs(3));
  const Obstacle& car = scenario.obstacles[1];
  EXPECT_EQ(car.type, "car");
  EXPECT_EQ(car.role, ObstacleRole::dynamic);
  ASSERT_THAT(car.trajectory, SizeIs(30));
  for (std::size_t i = 0; i < car.trajectory.size(); ++i) {
    const State& state = car.trajectory[i];
    const double t_s = 0.1 * static_cast<double>(i + 1);
    EXPECT_EQ(state.time_step, (Range<long>{long(i) + 1, long(i) + 1}));
    EXPECT_NEAR(state.position_m->x(), 20 + 8 * t_s + 0.25 * t_s * t_s, 1e-6);
    EXPECT_NEAR(state.speed_mps->least, 8 + 0.5 * t_s, 1e-6);
    EXPECT_EQ(state.acceleration_mps2->most, 0.5);
  }
}

TEST(CommonRoadScenario, ShapesAreBoxesCirclesAndPolygons) {
  const Scenario scenario = junction();
  const auto& box = std::get<RectangleShape>(scenario.obstacles[0].shape.at(0));
  EXPECT_EQ(box.length_m, 4.5);
  EXPECT_EQ(box.width_m, 1.8);
  const Obstacle& walker = scenario.obstacles[2];
  EXPECT_THAT(std::get<PolygonShape>(walker.shape.at(0)).corners_m, SizeIs(4));
  ASSERT_THAT(walker.occupancy_set, SizeIs(5));
  const auto& circle = std::get<CircleShape>(walker.occupancy_set[2].region.at(0));
  EXPECT_EQ(circle.radius_m, 1.3);
  EXPECT_EQ(circle.centre_m, Eigen::Vector2d(80, 10));
  EXPECT_THAT(walker.trajectory, IsEmpty());
}

TEST(CommonRoadScenario, GoalsAreLanesOrShapesWithIntervals) {
  const Scenario scenario = junction();
  ASSERT_THAT(scenario.planning_problems, SizeIs(1));
  const PlanningProblem& problem = scenario.planning_problems[0];
  EXPECT_EQ(problem.initial_state.speed_mps->least, 10.0);
  EXPECT_EQ(problem.initial_state.others[0].first, "yawRate");
  ASSERT_THAT(problem.goals, SizeIs(2));
  EXPECT_THAT(problem.goals[0].lanelets, ElementsAre("12", "11"));
  EXPECT_EQ(problem.goals[0].speed_mps, (Range<double>{5, 14}));
  EXPECT_EQ(problem.goals[0].heading_rad, (Range<double>{-0.2, 0.2}));
  EXPECT_EQ(problem.goals[0].time_step, (Range<long>{60, 120}));
  EXPECT_FALSE(problem.goals[0].position_m);
  const auto& region = std::get<RectangleShape>(problem.goals[1].region.at(0));
  EXPECT_EQ(region.centre_m, Eigen::Vector2d(56.75, -30));
}

TEST(CommonRoadScenario, LightsAreCyclesOfTimeSteps) {
  const Scenario scenario = parse(
      R"(<trafficLight id="7"><cycle>
      <cycleElement><duration>60</duration><color>red</color></cycleElement>
      <cycleElement><duration> 2.5</duration><color> green </color></cycleElement>
      <cycleElement><duration>soon</duration><color>yellow</color></cycleElement>
      <timeOffset>20</timeOffset></cycle><active>false</active></trafficLight>
      <trafficLight id="8"/>)");
  ASSERT_EQ(scenario.lights.size(), 2u);
  const TrafficLight& light = scenario.lights[0];
  EXPECT_EQ(light.id, "7");
  EXPECT_EQ(light.offset_steps, 20.0);
  EXPECT_FALSE(light.is_active);
  ASSERT_EQ(light.cycle.size(), 3u);
  EXPECT_EQ(light.cycle[0].colour, "red");
  EXPECT_EQ(light.cycle[0].duration_steps, 60.0);
  EXPECT_EQ(light.cycle[1].colour, "green");
  EXPECT_EQ(light.cycle[1].duration_steps, 2.5);
  EXPECT_EQ(light.cycle[2].duration_steps, 0.0);
  EXPECT_TRUE(scenario.lights[1].is_active);
  EXPECT_TRUE(scenario.lights[1].cycle.empty());
}

TEST(CommonRoadScenario, TheOldFormatNamesTheRoleInAnElement) {
  const Scenario scenario =
      parse("<obstacle id=\"3\"><role>static</role><type>unknown</type>" + kBox + kStart +
            "</obstacle><obstacle id=\"4\"><role>dynamic"
            "</role><type>car</type>" +
            kBox + kStart + "</obstacle>");
  EXPECT_EQ(scenario.obstacles[0].role, ObstacleRole::fixed);
  EXPECT_EQ(scenario.obstacles[1].role, ObstacleRole::dynamic);
}

TEST(CommonRoadScenario, GroupsOfShapesAreTakenTogether) {
  const Scenario scenario = parse(
      "<staticObstacle id=\"3\"><shape><shapeGroup><shape><circle><radius>1</radius></circle>"
      "</shape><shape><circle><radius>2</radius></circle></shape></shapeGroup></shape>" +
      kStart + "</staticObstacle>");
  EXPECT_THAT(scenario.obstacles[0].shape, SizeIs(2));
}

std::string message_of(const std::string& body) {
  return tests::refusal_of([&] { parse(body); });
}

TEST(CommonRoadScenario, UnusableObstaclesAreRefusedWithTheirPlace) {
  EXPECT_THAT(message_of("<staticObstacle id=\"3\">" + kStart + "</staticObstacle>"),
              testing::AllOf(HasSubstr("no shape"), HasSubstr("staticObstacle")));
  EXPECT_THAT(message_of("<obstacle id=\"3\"><role>flying</role></obstacle>"), HasSubstr("flying"));
  EXPECT_THAT(message_of("<planningProblem id=\"3\"/>"), HasSubstr("initialState"));
  const std::string late = "<staticObstacle id=\"3\">" + kBox +
                           "<initialState><position><point><x>1</x><y>2</y></point></position>" +
                           exact("time", "0.5") + "</initialState></staticObstacle>";
  EXPECT_THAT(message_of(late), HasSubstr("time step 0.5"));
  const std::string turned = "<planningProblem id=\"1\">" + kStart +
                             "<goalState><time><intervalStart>9</intervalStart>"
                             "<intervalEnd>5</intervalEnd></time></goalState></planningProblem>";
  EXPECT_THAT(message_of(turned), HasSubstr("from 9 to 5"));
}

TEST(CommonRoadScenario, ATimeStepOfNothingIsRefused) {
  EXPECT_THROW(parse_scenario("<commonRoad timeStepSize=\"0\"/>", "made.xml"), InputError);
  EXPECT_THROW(parse_scenario("<OpenDRIVE/>", "made.xml"), InputError);
}

}  // namespace
}  // namespace roadbed::map::commonroad
