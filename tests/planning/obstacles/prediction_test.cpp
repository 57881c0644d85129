#include "roadbed/planning/obstacles/prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "roadbed/planning/lateral/collision.h"
#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

using geometry::Pose2;
using geometry::Trajectory;
using geometry::TrajectoryPoint;

// A corner of a body 4 m long and 2 m wide.
Eigen::Vector2d corner_at(const Trajectory& motion, double t_s) {
  return motion.at(t_s).pose() * Eigen::Vector2d(2.0, -1.0);
}

TEST(Bend, IsTheMostThatACornerLeavesItsChordByOrALittleMore) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double used = 0.0;  // of the bound, by the worst
  for (int i = 0; i < 200; ++i) {
    std::vector<TrajectoryPoint> points{{.heading_rad = 3.0 * unit(random)}};
    for (int k = 0; k < 6; ++k) {
      TrajectoryPoint next = points.back();
      next.t_s += 0.5 + 0.4 * unit(random);
      next.x_m += 3.0 * unit(random);
      next.y_m += 3.0 * unit(random);
      next.heading_rad += (i % 2) * 0.4 * unit(random);
      points.push_back(next);
    }
    const Trajectory motion(points);
    const double from_s = 0.7 + unit(random), to_s = from_s + 0.1 + 2.0 * std::abs(unit(random));
    const Eigen::Vector2d a = corner_at(motion, from_s), b = corner_at(motion, to_s);
    const double bound_m = bend_m(motion, std::hypot(2.0, 1.0), from_s, to_s);
    for (int k = 0; k <= 500; ++k) {
      const double t_s = from_s + (to_s - from_s) * k / 500.0;
      const double off_m = (corner_at(motion, t_s) - (a + k / 500.0 * (b - a))).norm();
      EXPECT_LE(off_m, bound_m + 1e-12);
      if (bound_m > 0.0) used = std::max(used, off_m / bound_m);
    }
  }
  EXPECT_GT(used, 0.99);
}

ObservedMotion random_motion(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  return {.t_s = 3.0 * unit(random),
          .pose = {20.0 * unit(random), 20.0 * unit(random), 3.0 * unit(random)},
          .speed_mps = 12.0 * unit(random),
          .turn_rate_radps = 0.8 * unit(random)};
}

// Follows ẋ = v cos ψ, ẏ = v sin ψ, ψ̇ = ω by small midpoint steps.
Pose2 integrated(const ObservedMotion& seen, double after_s) {
  constexpr int kSteps = 20000;
  const double dt = after_s / kSteps;
  Pose2 pose = seen.pose;
  for (int i = 0; i < kSteps; ++i) {
    const double heading = pose.heading_rad + 0.5 * dt * seen.turn_rate_radps;
    pose.x_m += dt * seen.speed_mps * std::cos(heading);
    pose.y_m += dt * seen.speed_mps * std::sin(heading);
    pose.heading_rad += dt * seen.turn_rate_radps;
  }
  return pose;
}

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(a.heading_rad, b.heading_rad, tolerance);
}

TEST(Prediction, OfConstantTurnSolvesItsEquationsOfMotion) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const ObservedMotion seen = random_motion(random);
    const Prediction prediction = Prediction::constant_turn(seen);
    for (const double after_s : {-1.0, 0.0, 0.7, 5.0}) {
      expect_near(prediction.at(seen.t_s + after_s), integrated(seen, after_s), 1e-6);
    }
  }
}

TEST(Prediction, OfConstantVelocityIgnoresTheTurn) {
  const ObservedMotion seen{.t_s = 2.0,
                            .pose = {1.0, 2.0, 0.5 * std::numbers::pi},
                            .speed_mps = 3.0,
                            .turn_rate_radps = 0.4};
  expect_near(Prediction::constant_velocity(seen).at(6.0), {1.0, 14.0, 0.5 * std::numbers::pi},
              1e-12);
}

TEST(Prediction, OfARecordedMotionIsTheMotion) {
  const Trajectory motion({{.t_s = 1.0}, {.t_s = 3.0, .x_m = 4.0, .heading_rad = 0.2}});
  const Prediction prediction = Prediction::recorded(motion);
  expect_near(prediction.at(2.0), {2.0, 0.0, 0.1}, 1e-12);
  expect_near(prediction.at(9.0), {4.0, 0.0, 0.2}, 1e-12);
  EXPECT_EQ(prediction.fastest_mps(1.0, 4.0, 9.0), 0.0);
  EXPECT_NEAR(prediction.fastest_mps(1.0, 0.0, 9.0), 0.5 * (4.0 + 0.2), 1e-12);
}

TEST(Prediction, AlongALineKeepsItsOffsetAndDirection) {
  const tests::AnalyticLine circle{.curvature = {0.02, 0.0, 0.0, 0.0, 0.0}};  // centre (0, 50)
  for (const double direction : {1.0, -1.0}) {
    const double heading = 0.4 + (direction < 0.0 ? std::numbers::pi : 0.0);
    const ObservedMotion seen{.t_s = 1.0, .pose = {0.0, 0.0, heading}, .speed_mps = 5.0};
    const Prediction prediction =
        Prediction::along_line(circle.view(), {.s_m = 20.0, .d_m = 2.0}, seen, 3.0);
    for (const double after_s : {0.0, 1.1, 2.5, 3.0}) {
      const double angle = (20.0 + direction * 5.0 * after_s) / 50.0;
      const Pose2 at = prediction.at(1.0 + after_s);
      EXPECT_NEAR(at.x_m, 48.0 * std::sin(angle), 2e-3);
      EXPECT_NEAR(at.y_m, 50.0 - 48.0 * std::cos(angle), 2e-3);
      EXPECT_NEAR(std::cos(at.heading_rad - angle), direction, 1e-6);
    }
    expect_near(prediction.at(9.0), prediction.at(4.0), 0.0);
  }
}

TEST(Prediction, NeverMovesAPointFasterThanItSays) {
  std::mt19937 random(5);
  const tests::AnalyticLine line{.curvature = {0.02, 1e-3, 0.0, 0.0, 0.0}};
  for (int i = 0; i < 40; ++i) {
    const ObservedMotion seen = random_motion(random);
    for (const Prediction& prediction :
         {Prediction::constant_velocity(seen), Prediction::constant_turn(seen),
          Prediction::along_line(line.view(), {.s_m = 10.0, .d_m = 1.0}, seen, 4.0)}) {
      const double bound_mps = prediction.fastest_mps(2.5, seen.t_s, seen.t_s + 4.0);
      for (double t_s = seen.t_s; t_s < seen.t_s + 3.99; t_s += 0.01) {
        for (const Eigen::Vector2d& point :
             {Eigen::Vector2d(2.5, 0.0), Eigen::Vector2d(0.0, -2.5)}) {
          const Eigen::Vector2d moved =
              prediction.at(t_s + 0.01) * point - prediction.at(t_s) * point;
          EXPECT_LE(moved.norm(), 0.01 * bound_mps + 1e-9);
        }
      }
    }
  }
}

TEST(Prediction, RefusesWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const tests::AnalyticLine line;
  EXPECT_THROW(Prediction::constant_velocity({.pose = {}, .speed_mps = nan}),
               std::invalid_argument);
  EXPECT_THROW(Prediction::constant_turn({.pose = {}, .turn_rate_radps = nan}),
               std::invalid_argument);
  EXPECT_THROW(Prediction::along_line(line.view(), {}, {}, -1.0), std::invalid_argument);
  EXPECT_THROW(Prediction::recorded(Trajectory()), std::invalid_argument);
}

std::vector<TrajectoryPoint> straight_drive(double length_m, double step_m, double speed_mps) {
  std::vector<TrajectoryPoint> drive;
  for (double x = 0.0; x <= length_m + 1e-9; x += step_m) {
    drive.push_back({.t_s = x / speed_mps, .x_m = x, .speed_mps = speed_mps});
  }
  return drive;
}

bool is_free(const std::vector<TrajectoryPoint>& drive,
             const std::vector<PredictedObstacle>& predicted) {
  return CollisionChecker({.obstacles = {}, .predicted = predicted}, geometry::VehicleShape{}, {})
      .is_free(drive);
}

TEST(CollisionChecker, SeesAPostThatFliesAcrossTheDriveBetweenTwoPoints) {
  // 40 m/s along, 30 m/s across: each passes the other within 0.1 s, the points are 1 s apart.
  const auto drive = straight_drive(160.0, 40.0, 40.0);
  const auto crossing = [](double at_s) {
    return PredictedObstacle{
        .id = "post",
        .length_m = 0.05,
        .width_m = 0.05,
        .motion = Prediction::constant_velocity(
            {.t_s = at_s, .pose = {60.0, 0.0, 0.5 * std::numbers::pi}, .speed_mps = 30.0})};
  };
  EXPECT_FALSE(is_free(drive, {crossing(1.5)}));
  EXPECT_TRUE(is_free(drive, {crossing(1.7)}));
  EXPECT_TRUE(is_free(drive, {crossing(1.2)}));
}

TEST(CollisionChecker, LooksForEverAtWhatIsPredictedToStand) {
  const auto drive = straight_drive(100.0, 1.0, 10.0);
  const auto at_the_end = [](double speed_mps) {
    return PredictedObstacle{.id = "car",
                             .motion = Prediction::constant_velocity(
                                 {.t_s = 9.0, .pose = {95.0, 0.0, 0.0}, .speed_mps = speed_mps})};
  };
  EXPECT_FALSE(is_free(drive, {at_the_end(0.0)}));
  EXPECT_TRUE(is_free(drive, {at_the_end(-0.1)}));  // moves, and is met after the horizon
}

TEST(CollisionChecker, AgreesWithDenseSamplingOfTurningObstacles) {
  std::mt19937 random(23);
  int free = 0, colliding = 0;
  const auto drive = straight_drive(40.0, 2.0, 10.0);
  for (int scene = 0; scene < 300; ++scene) {
    ObservedMotion seen = random_motion(random);
    seen.pose.x_m += 20.0;
    seen.pose.y_m *= 0.4;
    const PredictedObstacle obstacle{.id = "turns", .motion = Prediction::constant_turn(seen)};
    double slack_m = 1e300;
    for (int k = 0; k <= 8000; ++k) {
      const double t_s = 4.0 * k / 8000.0, driven_m = 10.0 * t_s;
      const auto body = geometry::body_at({driven_m, 0.0, 0.0}, geometry::VehicleShape{});
      const double turn = seen.turn_rate_radps, after = t_s - seen.t_s;
      const double heading = seen.pose.heading_rad + turn * after;
      const double radius = seen.speed_mps / turn;
      const Eigen::Vector2d at(
          seen.pose.x_m + radius * (std::sin(heading) - std::sin(seen.pose.heading_rad)),
          seen.pose.y_m - radius * (std::cos(heading) - std::cos(seen.pose.heading_rad)));
      const geometry::Rectangle other{at, {std::cos(heading), std::sin(heading)}, 2.25, 0.9};
      const double demanded_m = 0.15 + 0.15 * std::min(1.0, driven_m / 10.0);
      slack_m = std::min(slack_m, geometry::distance_m(body, other) - demanded_m);
    }
    if (is_free(drive, {obstacle})) {
      EXPECT_GE(slack_m, -1e-9) << "scene " << scene;
      ++free;
    } else {
      EXPECT_LE(slack_m, 0.02 + 0.01) << "scene " << scene;
      ++colliding;
    }
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(colliding, 50);
}

}  // namespace
}  // namespace roadbed::planning
