#include "roadbed/planning/obstacles/traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace roadbed::tools {
namespace {

constexpr double kSeen_s = 3.0;

/// Drives a circle at 8 m/s until 3 s; what it does later is given.
planning::Obstacle circling(double later_turn_rate) {
  planning::Obstacle obstacle{.id = "other", .motion = {}};
  std::vector<geometry::TrajectoryPoint> points;
  double x = 0.0, y = 0.0, heading = 0.0;
  for (int k = 0; k <= 600; ++k) {
    points.push_back(
        {.t_s = 0.01 * k, .x_m = x, .y_m = y, .heading_rad = heading, .speed_mps = 8.0});
    const double rate = k < 300 ? 0.3 : later_turn_rate;
    x += 0.08 * std::cos(heading + 0.005 * rate);
    y += 0.08 * std::sin(heading + 0.005 * rate);
    heading += 0.01 * rate;
  }
  obstacle.motion = geometry::Trajectory(std::move(points));
  return obstacle;
}

planning::Obstacle foreseen(const planning::Obstacle& truth,
                            const planning::TimeSpan& validity = {0, 6}) {
  std::vector<planning::Obstacle> obstacles{truth};
  obstacles.front().validity = validity;
  return planning::PredictedTraffic({obstacles}, kSeen_s).obstacles().at(0);
}

TEST(PredictedTraffic, DoesNotDependOnTheFuture) {
  const planning::Obstacle left = foreseen(circling(0.3)), right = foreseen(circling(-0.8));
  for (double t = kSeen_s; t < 10.0; t += 0.1) {
    EXPECT_EQ(left.motion.at(t).x_m, right.motion.at(t).x_m);
    EXPECT_EQ(left.motion.at(t).y_m, right.motion.at(t).y_m);
  }
}

TEST(PredictedTraffic, KeepsTheTurnThatWasSeenForTwoSeconds) {
  const planning::Obstacle truth = circling(0.3), seen = foreseen(truth);
  for (const double ahead_s : {0.0, 0.5, 1.0, 2.0}) {
    const geometry::TrajectoryPoint a = truth.motion.at(kSeen_s + ahead_s),
                                    b = seen.motion.at(kSeen_s + ahead_s);
    EXPECT_NEAR(a.x_m, b.x_m, 0.05) << ahead_s;
    EXPECT_NEAR(a.y_m, b.y_m, 0.05) << ahead_s;
    EXPECT_NEAR(a.heading_rad, b.heading_rad, 0.01);
  }
  EXPECT_NEAR(seen.motion.at(kSeen_s + 2.0).heading_rad, seen.motion.at(kSeen_s + 6.0).heading_rad,
              1e-9);
}

TEST(PredictedTraffic, KnowsOnlyOfWhatIsThereAndKeepsItThere) {
  std::vector<planning::Obstacle> obstacles{circling(0.3), circling(0.3), circling(0.3)};
  obstacles[0].validity = {0.0, 3.2};
  obstacles[1].validity = {3.5, 6.0};
  obstacles[2].validity = {0.0, 2.0};
  const planning::PredictedTraffic foreseen({obstacles}, kSeen_s);
  EXPECT_TRUE(foreseen.obstacles()[0].is_there(5.0));  // that it leaves is not known
  EXPECT_FALSE(foreseen.obstacles()[1].is_there(5.0));
  EXPECT_FALSE(foreseen.obstacles()[2].is_there(5.0));
}

TEST(PredictedTraffic, WhatJustAppearedKeepsTheSpeedThatItIsSaidToHave) {
  const planning::Obstacle seen = foreseen(circling(0.3), {kSeen_s, 6.0});
  EXPECT_NEAR(seen.motion.at(kSeen_s).speed_mps, 8.0, 1e-9);
  EXPECT_NEAR(seen.motion.at(kSeen_s).heading_rad, seen.motion.at(kSeen_s + 4.0).heading_rad, 1e-9);
}

/// Straight on at 10 m/s, and from 1 s on with an acceleration.
planning::Obstacle speeding_up(double acceleration_mps2) {
  std::vector<geometry::TrajectoryPoint> points;
  double x = 0.0, speed = 10.0;
  for (int k = 0; k <= 600; ++k) {
    points.push_back({.t_s = 0.01 * k, .x_m = x, .speed_mps = speed});
    const double next = k < 100 ? speed : std::max(0.0, speed + 0.01 * acceleration_mps2);
    x += 0.005 * (speed + next);
    speed = next;
  }
  planning::Obstacle obstacle{.id = "other", .motion = {}};
  obstacle.motion = geometry::Trajectory(std::move(points));
  return obstacle;
}

TEST(PredictedTraffic, BrakingGoesOnForTwoSecondsAndSpeedingUpForOne) {
  const planning::Obstacle brakes = foreseen(speeding_up(-2.0));  // 6 m/s when it is seen
  EXPECT_NEAR(brakes.motion.at(kSeen_s).speed_mps, 6.0, 0.01);
  EXPECT_NEAR(brakes.motion.at(kSeen_s + 1.0).speed_mps, 4.0, 0.02);
  EXPECT_NEAR(brakes.motion.at(kSeen_s + 5.0).speed_mps, 2.0, 0.03);
  const double way_m = brakes.motion.at(kSeen_s + 4.0).x_m - brakes.motion.at(kSeen_s).x_m;
  EXPECT_NEAR(way_m, 0.5 * (6.0 + 2.0) * 2.0 + 2.0 * 2.0, 0.1);
  const planning::Obstacle faster = foreseen(speeding_up(1.5));  // 13 m/s then
  EXPECT_NEAR(faster.motion.at(kSeen_s + 5.0).speed_mps, 14.5, 0.03);
  const planning::Obstacle stops = foreseen(speeding_up(-4.5));  // 1 m/s: never backwards
  EXPECT_NEAR(stops.motion.at(kSeen_s + 5.0).speed_mps, 0.0, 1e-9);
  EXPECT_NEAR(stops.motion.at(kSeen_s + 5.0).x_m, stops.motion.at(kSeen_s).x_m + 1.0 / 9.0, 0.05);
}

TEST(PredictedTraffic, WhatStandsWillStand) {
  using Points = std::vector<geometry::TrajectoryPoint>;
  planning::Obstacle parked{.id = "parked", .motion = {}};
  parked.motion = geometry::Trajectory(Points{{.x_m = 5.0}});
  EXPECT_TRUE(foreseen(parked).is_static());
  parked.motion = geometry::Trajectory(Points{{.t_s = 0.0, .x_m = 5.0}, {.t_s = 6.0, .x_m = 5.0}});
  EXPECT_TRUE(foreseen(parked).is_static());
}

}  // namespace
}  // namespace roadbed::tools
