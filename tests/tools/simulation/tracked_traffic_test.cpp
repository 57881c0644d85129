// What a drive's planner gets to know of others, against what they truly are.
#include "roadbed/tools/simulation/tracked_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/object_sensor.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

geometry::Rectangle vehicle_at(double x_m) {
  return geometry::body_at({x_m, 0.0, 0.0}, geometry::VehicleShape{});
}

planning::Obstacle driving(const std::string& id, double x_m, double y_m, double speed_mps) {
  return {.id = id,
          .motion = drive_through(
              {{0.0, {x_m, y_m, 0.0}}, {100.0, {x_m + 100.0 * speed_mps, y_m, 0.0}}})};
}

TEST(ObjectSensor, MeasuresWithTheNoiseThatIsAskedFor) {
  const World world = tests::straight_world({}, {driving("a", 40.0, 3.0, 7.0)});
  ScenarioNoise noise;
  noise.object = {.position_m = 0.3, .heading_rad = 0.02, .speed_mps = 0.4};
  ObjectSensor sensor(world, noise, 5);
  double x2 = 0.0, y2 = 0.0, heading2 = 0.0, speed2 = 0.0;
  constexpr int kTimes = 900;
  for (int k = 0; k < kTimes; ++k) {
    const double t_s = 0.1 * k;
    const auto seen = sensor.look(t_s, vehicle_at(10.0));
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_EQ(seen[0].detection.id, "") << "who it is has to be found out";
    const planning::Detection& measured = seen[0].detection;
    x2 += std::pow(measured.centre.x_m - 40.0 - 7.0 * t_s, 2);
    y2 += std::pow(measured.centre.y_m - 3.0, 2);
    heading2 += std::pow(measured.centre.heading_rad, 2);
    speed2 += std::pow(measured.speed_mps - 7.0, 2);
  }
  // Of 900 samples a standard deviation is known within 2.4 %, its standard error.
  EXPECT_NEAR(std::sqrt(x2 / kTimes), 0.3, 0.025);
  EXPECT_NEAR(std::sqrt(y2 / kTimes), 0.3, 0.025);
  EXPECT_NEAR(std::sqrt(heading2 / kTimes), 0.02, 0.0017);
  EXPECT_NEAR(std::sqrt(speed2 / kTimes), 0.4, 0.034);
}

TEST(ObjectSensor, MeasuresTheWayThatSomebodyMoves) {
  const auto seen_of = [](double heading_rad, const Eigen::Vector2d& to) {
    const World world = tests::straight_world(
        {}, {{.id = "walker",
              .motion = drive_through({{0.0, {30.0, 0.0, heading_rad}},
                                       {10.0, {30.0 + to.x(), to.y(), heading_rad}}})}});
    return ObjectSensor(world, {}, 1).look(5.0, vehicle_at(10.0)).at(0).detection;
  };
  const planning::Detection backwards = seen_of(0.1, {-10.0, 0.0});
  EXPECT_NEAR(backwards.centre.heading_rad, 0.1, 1e-9);
  EXPECT_NEAR(backwards.speed_mps, -1.0, 1e-9);
  const planning::Detection sideways = seen_of(0.0, {0.0, 15.0});
  EXPECT_NEAR(sideways.centre.heading_rad, 0.5 * M_PI, 1e-9);
  EXPECT_NEAR(sideways.speed_mps, 1.5, 1e-9);
}

TEST(ObjectSensor, LosesTheShareThatIsAskedForAndAllInADropout) {
  const World world = tests::straight_world({}, {driving("a", 40.0, 3.0, 1.0)});
  ScenarioNoise noise;
  noise.dropout_ratio = 0.3;
  noise.dropouts = {{20.0, 25.0}};
  ObjectSensor sensor(world, noise, 5);
  int seen = 0, seen_in_dropout = 0;
  for (int k = 0; k < 900; ++k) {
    const double t_s = 0.1 * k;
    const bool is_there = !sensor.look(t_s, vehicle_at(10.0)).empty();
    (t_s > 19.99 && t_s < 24.99 ? seen_in_dropout : seen) += is_there ? 1 : 0;
  }
  EXPECT_EQ(seen_in_dropout, 0);
  EXPECT_NEAR(seen / 850.0, 0.7, 0.065);  // four standard errors
}

TEST(ObjectSensor, SeesNobodyBeyondItsRangeOrBehindAnother) {
  const World world = tests::straight_world(
      {}, {driving("lorry", 30.0, 0.0, 0.0), driving("hidden", 38.0, 0.0, 0.0),
           driving("far", 80.0, 8.0, 0.0)});
  ScenarioNoise noise;
  noise.object_range_m = 60.0;
  ObjectSensor sensor(world, noise, 1);
  const auto seen = sensor.look(0.0, vehicle_at(10.0));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].obstacle, 0U);
}

class TrackedTraffics : public testing::Test {
 protected:
  /// Looks at the world for a time from one place.
  std::vector<planning::Obstacle> looked(const World& world, const ScenarioNoise& noise,
                                         double for_s) {
    Scenario scenario;
    scenario.noise = noise;
    traffic_.emplace(world, scenario);
    std::vector<planning::Obstacle> known;
    for (int k = 0; 0.1 * k <= for_s + 1e-9; ++k) {
      known = traffic_->look(0.1 * k, vehicle_at(10.0), {10.0, 0.0, 0.0});
    }
    return known;
  }

  std::optional<TrackedTraffic> traffic_;
};

TEST_F(TrackedTraffics, FollowEverybodyBetterThanTheyAreMeasured) {
  ScenarioNoise noise;
  noise.object = {.position_m = 0.4, .heading_rad = 0.03, .speed_mps = 0.4};
  noise.dropout_ratio = 0.1;
  const World world = tests::straight_world(
      {},
      {driving("a", 25.0, 3.5, 1.5), driving("b", 35.0, -3.5, 2.5), driving("c", 60.0, 7.0, 0.0)});
  looked(world, noise, 60.0);
  const TrackingQuality& quality = traffic_->quality();
  EXPECT_GT(quality.measurements, 1500U);
  const auto rms_m = [&](double sum_m2) {
    return std::sqrt(sum_m2 / static_cast<double>(quality.measurements));
  };
  EXPECT_NEAR(rms_m(quality.measured_m2), 0.4 * std::sqrt(2.0), 0.03);
  EXPECT_LT(rms_m(quality.tracked_m2), 0.3);
  EXPECT_EQ(quality.identity_swaps, 0U);
}

TEST_F(TrackedTraffics, KnowNothingOfTheFuture) {
  const auto known = [&](double then_mps) {
    planning::Obstacle other{.id = "a", .motion = {}};
    other.motion = drive_through({{0.0, {40.0, 0.0, 0.0}},
                                  {3.0, {64.0, 0.0, 0.0}},
                                  {13.0, {64.0 + 10.0 * then_mps, 0.0, 0.0}}});
    const World world = tests::straight_world({}, {other});
    return looked(world, {}, 2.9).front();
  };
  const planning::Obstacle brakes = known(0.0), goes_on = known(8.0);
  for (double t_s = 2.0; t_s < 12.0; t_s += 0.1) {
    EXPECT_EQ(brakes.pose_at(t_s).x_m, goes_on.pose_at(t_s).x_m) << t_s;
  }
  EXPECT_NEAR(brakes.pose_at(6.0).x_m, 64.0 + 24.0, 0.5);
  EXPECT_EQ(brakes.id, "a");
}

TEST(TrackedTrafficInReports, HasTheNumbersOfTheWorld) {
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "slower_lead.json");
  scenario.duration_s = 12.0;
  World world = make_world(scenario);
  const Drive driven = drive(scenario, world);
  std::size_t parts = 0;
  for (const DriveCycle& cycle : driven.cycles) {
    for (const planning::HypothesisOutcome& hypothesis : cycle.hypotheses) {
      for (const planning::StPicture::Part& part : hypothesis.st.parts) {
        ASSERT_LT(part.obstacle, world.obstacles.size());
        ++parts;
      }
    }
    const auto is_lead = [&](const planning::Obstacle& one) { return one.id == cycle.lead->id; };
    EXPECT_TRUE(!cycle.lead || std::ranges::any_of(world.obstacles, is_lead));
  }
  EXPECT_GT(parts, 100U);
}

TEST_F(TrackedTraffics, ForeseeFiveSecondsOfWhoMoves) {
  const World world = tests::straight_world(
      {}, {driving("stands", 30.0, 4.0, 0.0), driving("moves", 60.0, 0.0, 6.0)});
  looked(world, {}, 2.0);
  double sum = 0.0;
  for (const ForeseenMotion& motion : traffic_->foreseen()) {
    EXPECT_EQ(motion.obstacle, 1U);
    ASSERT_EQ(motion.points.size(), 11U);
    EXPECT_NEAR(motion.points[10].x() - motion.points[0].x(), 30.0, 0.2);
    sum += motion.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

}  // namespace
}  // namespace roadbed::tools
