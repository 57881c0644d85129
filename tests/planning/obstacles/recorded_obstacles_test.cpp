#include "roadbed/planning/obstacles/recorded_obstacles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::planning {
namespace {

using testing::HasSubstr;

map::commonroad::Scenario scenario_of(const std::string& elements) {
  return map::commonroad::parse_scenario(
      "<commonRoad timeStepSize=\"0.1\" commonRoadVersion=\"2020a\">" + elements + "</commonRoad>",
      "made.xml");
}

std::vector<ObstacleInSource> boxes_of(const std::string& elements) {
  const map::commonroad::Scenario scenario = scenario_of(elements);
  return recorded_boxes(scenario, initial_step(scenario).value_or(0), "made.xml");
}

std::string refusal_of(const std::string& elements) {
  return tests::refusal_of([&] { boxes_of(elements); });
}

const std::string kShape =
    "<shape><rectangle><length>4</length><width>2</width></rectangle></shape>";
const std::string kPoint = "<point><x>1</x><y>2</y></point>";

std::string state(const std::string& element, const std::string& position,
                  const std::string& heading, const std::string& time) {
  return "<" + element + "><position>" + position + "</position><orientation>" + heading +
         "</orientation><time>" + time + "</time></" + element + ">";
}

std::string exact(const std::string& number) { return "<exact>" + number + "</exact>"; }

std::string between(const std::string& least, const std::string& most) {
  return "<intervalStart>" + least + "</intervalStart><intervalEnd>" + most + "</intervalEnd>";
}

std::string dynamic(const std::string& rest) {
  return "<dynamicObstacle id=\"42\"><type>car</type>" + kShape + rest + "</dynamicObstacle>";
}

const std::string kStart = state("initialState", kPoint, exact("0.5"), exact("0"));

std::string occupancy(const std::string& shapes, const std::string& time) {
  return "<occupancy><shape>" + shapes + "</shape><time>" + time + "</time></occupancy>";
}

const std::string kCircle =
    "<circle><radius>1.5</radius><center><x>7</x><y>8</y></center></circle>";
const std::string kSlanted =
    "<rectangle><length>6</length><width>1</width><orientation>0.7</orientation>"
    "<center><x>3</x><y>4</y></center></rectangle>";
const std::string kTriangle =
    "<polygon><point><x>0</x><y>0</y></point><point><x>5</x><y>0</y></point>"
    "<point><x>0</x><y>3</y></point></polygon>";

void expect_box(const ObstacleInSource& box, const geometry::Pose2& centre, double length_m,
                double width_m) {
  ASSERT_TRUE(box.is_static());
  const auto& at = box.motion.points().front();
  EXPECT_NEAR(at.x_m, centre.x_m, 1e-9);
  EXPECT_NEAR(at.y_m, centre.y_m, 1e-9);
  EXPECT_NEAR(at.heading_rad, centre.heading_rad, 1e-9);
  EXPECT_NEAR(box.length_m, length_m, 1e-9);
  EXPECT_NEAR(box.width_m, width_m, 1e-9);
}

TEST(RecordedBoxes, EveryPartOfAnOccupancyStandsFromTheStartOfItsFirstStepToTheEndOfItsLast) {
  const auto boxes = boxes_of(dynamic(kStart + "<occupancySet>" +
                                      occupancy(kSlanted + kCircle, between("1", "10")) +
                                      occupancy(kTriangle, exact("11")) + "</occupancySet>"));
  ASSERT_EQ(boxes.size(), 4u);
  const std::vector<std::pair<double, double>> times{
      {0.0, 0.1}, {0.1, 1.1}, {0.1, 1.1}, {1.1, 1.2}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(boxes[i].id, "42." + std::to_string(i + 1));
    EXPECT_NEAR(boxes[i].validity.from_s, times[i].first, 2e-6);
    EXPECT_NEAR(boxes[i].validity.to_s, times[i].second, 2e-6);
    EXPECT_LE(boxes[i].validity.from_s, times[i].first);
    EXPECT_GE(boxes[i].validity.to_s, times[i].second);
  }
  expect_box(boxes[0], {1.0, 2.0, 0.5}, 4.0, 2.0);
  expect_box(boxes[1], {3.0, 4.0, 0.7}, 6.0, 1.0);
  expect_box(boxes[2], {7.0, 8.0, 0.0}, 3.0, 3.0);
  expect_box(boxes[3], {2.5, 1.5, 0.0}, 5.0, 3.0);
}

TEST(RecordedBoxes, WhatBelongsToThePlaceStandsForEver) {
  const auto boxes = boxes_of("<environmentObstacle id=\"5\"><type>building</type><shape>" +
                              kTriangle + "</shape></environmentObstacle>");
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].id, "5");
  EXPECT_TRUE(std::isinf(boxes[0].validity.from_s) && std::isinf(boxes[0].validity.to_s));
  expect_box(boxes[0], {2.5, 1.5, 0.0}, 5.0, 3.0);
}

TEST(RecordedBoxes, ATrajectoryIsThereFromItsFirstStateToItsLastInTheDrivesTime) {
  const std::string problem = "<planningProblem id=\"1\">" +
                              state("initialState", kPoint, exact("0"), exact("5")) +
                              "</planningProblem>";
  const auto boxes =
      boxes_of(dynamic(kStart + "<trajectory>" + state("state", kPoint, exact("0.6"), exact("7")) +
                       "</trajectory>") +
               problem);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_NEAR(boxes[0].validity.from_s, -0.5, 2e-6);
  EXPECT_NEAR(boxes[0].validity.to_s, 0.2, 2e-6);
  EXPECT_NEAR(boxes[0].motion.end_s(), 0.2, 1e-12);
  EXPECT_NEAR(boxes[0].motion.at(0.2).heading_rad, 0.6, 1e-12);
}

TEST(RecordedBoxes, WhatNoBoxHoldsForSureIsRefused) {
  const auto initial = [](const std::string& position, const std::string& heading,
                          const std::string& time) {
    return refusal_of(dynamic(state("initialState", position, heading, time)));
  };
  EXPECT_EQ(initial(kPoint, exact("0"), exact("0")), "accepted");
  EXPECT_EQ(initial(kPoint, between("1", "1"), exact("0")), "accepted");
  EXPECT_THAT(initial(kCircle, exact("0"), exact("0")),
              HasSubstr("made.xml: obstacle 42: the position of the state at time step 0"));
  EXPECT_THAT(initial("<lanelet ref=\"3\"/>", exact("0"), exact("0")), HasSubstr("the position"));
  EXPECT_THAT(initial(kPoint, between("0", "1"), exact("0")), HasSubstr("the orientation"));
  EXPECT_THAT(initial(kPoint, exact("0"), between("0", "1")), HasSubstr("the time"));
  const auto then = [](const std::string& rest) { return refusal_of(dynamic(kStart + rest)); };
  EXPECT_THAT(
      then("<trajectory>" + state("state", kPoint, exact("0"), exact("0")) + "</trajectory>"),
      HasSubstr("does not follow the one before"));
  EXPECT_THAT(then("<occupancySet>" + occupancy("", exact("1")) + "</occupancySet>"),
              HasSubstr("without a shape"));
  EXPECT_THAT(refusal_of("<environmentObstacle id=\"5\"/>"), HasSubstr("nothing says where it is"));
  EXPECT_THAT(refusal_of("<phantomObstacle id=\"6\"/>"), HasSubstr("nothing says where it is"));
  EXPECT_THAT(refusal_of("<phantomObstacle id=\"6\"><trajectory>" +
                         state("state", kPoint, exact("0"), exact("1")) +
                         "</trajectory></phantomObstacle>"),
              HasSubstr("a trajectory without an initial state"));
  EXPECT_THAT(
      refusal_of("<staticObstacle id=\"7\">" + kShape + kStart + "<trajectory>" +
                 state("state", kPoint, exact("0"), exact("1")) + "</trajectory></staticObstacle>"),
      HasSubstr("it is static, and has a prediction"));
}

std::string polygon(const std::vector<Eigen::Vector2d>& corners) {
  std::string points;
  for (const Eigen::Vector2d& corner : corners) {
    points += "<point><x>" + std::to_string(corner.x()) + "</x><y>" + std::to_string(corner.y()) +
              "</y></point>";
  }
  return "<polygon>" + points + "</polygon>";
}

TEST(RecordedBoxes, OfAPolygonHoldItTightly) {
  std::mt19937 random(33);
  std::uniform_real_distribution<double> angle(0.0, 6.28), size(1.0, 9.0), place(-50.0, 50.0);
  for (int round = 0; round < 200; ++round) {
    // A turned rectangle with a corner cut off, which its least rectangle is not smaller for.
    const geometry::Pose2 pose{place(random), place(random), angle(random)};
    const double length_m = size(random), width_m = 0.5 * size(random);
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(length_m, 0.0),
          Eigen::Vector2d(length_m, 0.9 * width_m), Eigen::Vector2d(0.95 * length_m, width_m),
          Eigen::Vector2d(0.0, width_m)}) {
      corners.push_back(pose * corner);
    }
    const auto boxes = boxes_of("<environmentObstacle id=\"8\"><type>building</type><shape>" +
                                polygon(corners) + "</shape></environmentObstacle>");
    ASSERT_EQ(boxes.size(), 1u);
    const ObstacleInSource& box = boxes.front();
    EXPECT_NEAR(box.length_m * box.width_m, length_m * width_m, 1e-3);
    const geometry::Pose2 centre = box.motion.points().front().pose();
    for (const Eigen::Vector2d& corner : corners) {
      const Eigen::Vector2d off = corner - centre.position();
      const Eigen::Vector2d ahead(std::cos(centre.heading_rad), std::sin(centre.heading_rad));
      EXPECT_LE(std::abs(off.dot(ahead)), 0.5 * box.length_m + 1e-5);
      EXPECT_LE(std::abs(ahead.x() * off.y() - ahead.y() * off.x()), 0.5 * box.width_m + 1e-5);
    }
  }
}

std::vector<ObstacleInSource> simulated(const std::string& elements) {
  const auto scenario = map::commonroad::parse_scenario(
      "<commonRoad timeStepSize=\"0.1\" commonRoadVersion=\"2020a\">" + elements + "</commonRoad>",
      "made.xml");
  return recorded_obstacles(scenario.obstacles.at(0), {.start_step = 0, .step_s = 0.1});
}

std::string rectangle(double length_m, double x_m, double heading_rad) {
  return "<rectangle><length>" + std::to_string(length_m) +
         "</length><width>2</width><orientation>" + std::to_string(heading_rad) +
         "</orientation><center><x>" + std::to_string(x_m) + "</x><y>2</y></center></rectangle>";
}

TEST(RecordedObstacles, OccupancySetHasItsOwnShapeAtEachTimeStep) {
  const auto pieces = simulated(
      dynamic(kStart + "<occupancySet>" + occupancy(rectangle(4.0, 2.0, 0.0), exact("1")) +
              occupancy(rectangle(9.0, 3.5, 0.3), exact("2")) +
              occupancy(rectangle(30.0, 5.0, 0.0), exact("3")) + "</occupancySet>"));
  ASSERT_EQ(pieces.size(), 4u);
  const std::vector<double> lengths_m{4.0, 4.0, 9.0, 30.0}, at_x_m{1.0, 2.0, 3.5, 5.0};
  for (std::size_t step = 0; step < 4; ++step) {
    const double t_s = 0.1 * static_cast<double>(step);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(pieces[k].validity.holds(t_s), k == step) << step << ' ' << k;
    }
    EXPECT_NEAR(pieces[step].length_m, lengths_m[step], 1e-9);
    EXPECT_NEAR(pieces[step].width_m, 2.0, 1e-9);
    EXPECT_NEAR(pieces[step].motion.at(t_s).x_m, at_x_m[step], 1e-9);
    EXPECT_EQ(pieces[step].id, "42");
  }
  EXPECT_NEAR(pieces[0].motion.at(0.0).heading_rad, 0.5, 1e-9);
  EXPECT_NEAR(pieces[2].motion.at(0.2).heading_rad, 0.3, 1e-9);
  EXPECT_NEAR(pieces[2].motion.at(0.2).speed_mps, 15.0, 1e-9);
  EXPECT_TRUE(pieces[2].validity.holds(0.29));
  EXPECT_FALSE(pieces[3].validity.holds(0.31));
}

TEST(RecordedObstacles, TrajectoryIsOneObstacle) {
  const auto one =
      simulated(dynamic(kStart + "<trajectory>" + state("state", kPoint, exact("0.5"), exact("1")) +
                        "</trajectory>"));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_TRUE(one[0].validity.holds(0.1));
  EXPECT_FALSE(one[0].validity.holds(0.2));
}

}  // namespace
}  // namespace roadbed::planning
