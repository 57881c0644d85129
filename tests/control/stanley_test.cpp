#include "roadbed/control/stanley.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "roadbed/control/single_track.h"
#include "roadbed/tests/control/default_vehicle.h"

namespace roadbed::control {
namespace {

using geometry::Pose2;

TEST(Stanley, LookForwardDistanceIsThatOfTheFigure) {
  EXPECT_DOUBLE_EQ(look_forward_m(0.0), 10.0);
  EXPECT_DOUBLE_EQ(look_forward_m(12.5), 10.0);
  EXPECT_DOUBLE_EQ(look_forward_m(20.0), 16.0);
  EXPECT_DOUBLE_EQ(look_forward_m(25.0), 20.0);
  EXPECT_DOUBLE_EQ(look_forward_m(60.0), 20.0);
}

TEST(Stanley, GainGrowsFromHalfToOne) {
  EXPECT_DOUBLE_EQ(cross_track_gain(0.0), 0.5);
  EXPECT_DOUBLE_EQ(cross_track_gain(10.0), 0.7);
  EXPECT_DOUBLE_EQ(cross_track_gain(25.0), 1.0);
  EXPECT_DOUBLE_EQ(cross_track_gain(40.0), 1.0);
}

TEST(Stanley, PathToTheLeftAsksForSteeringToTheLeft) {
  const TrackingError aside = tracking_error({}, kVehicle.wheelbase_m, {3.0, 0.5, 0.0});
  EXPECT_DOUBLE_EQ(aside.cross_track_m, 0.5);
  EXPECT_DOUBLE_EQ(aside.heading_rad, 0.0);
  EXPECT_NEAR(stanley_steering_rad(aside, 10.0, kVehicle), std::atan(0.7 * 0.5 / 10.0), 1e-15);
  const TrackingError turned =
      tracking_error({}, kVehicle.wheelbase_m, {kVehicle.wheelbase_m, 0.0, 0.1});
  EXPECT_NEAR(turned.cross_track_m, 0.0, 1e-12);
  EXPECT_NEAR(stanley_steering_rad(turned, 10.0, kVehicle), 0.1, 1e-12);
}

TEST(Stanley, ErrorsDoNotDependOnWhereTheMapsOriginIs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-50, 50), angle(-10, 10);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const Pose2 vehicle{place(random), place(random), angle(random)};
    const Pose2 path{place(random), place(random), angle(random)};
    const Pose2 moved{place(random), place(random), angle(random)};
    const TrackingError here = tracking_error(vehicle, 2.5, path);
    const TrackingError there = tracking_error(moved * vehicle, 2.5, moved * path);
    EXPECT_NEAR(here.cross_track_m, there.cross_track_m, 1e-10);
    EXPECT_NEAR(std::remainder(here.heading_rad - there.heading_rad, 2 * std::numbers::pi), 0.0,
                1e-10);
    EXPECT_LE(std::abs(here.heading_rad), std::numbers::pi);
  }
}

TEST(Stanley, SteeringNeverPassesTheLimit) {
  for (const double heading : {-3.0, 3.0}) {
    const double steering =
        stanley_steering_rad({.cross_track_m = 0.0, .heading_rad = heading}, 0.0, kVehicle);
    EXPECT_DOUBLE_EQ(steering, std::copysign(kVehicle.max_steering_rad, heading));
  }
}

SingleTrackState track_x_axis(SingleTrackState state, double duration_s) {
  constexpr double kStep_s = 0.01;
  for (double t = 0.0; t < duration_s; t += kStep_s) {
    const Eigen::Vector2d front = state.pose * Eigen::Vector2d(kVehicle.wheelbase_m, 0.0);
    const TrackingError error =
        tracking_error(state.pose, kVehicle.wheelbase_m, {front.x(), 0.0, 0.0});
    const double wanted = stanley_steering_rad(error, state.speed_mps, kVehicle);
    state = step(state, {.steering_rate_radps = (wanted - state.steering_rad) / kStep_s}, kStep_s,
                 kVehicle);
  }
  return state;
}

TEST(Stanley, ConvergesToTheLineFromBothSidesWithoutLeavingIt) {
  for (const double speed : {2.0, 5.0, 12.0, 20.0, 30.0}) {
    for (const double side_m : {-2.0, 2.0}) {
      const SingleTrackState start{.pose = {0.0, side_m, 0.1 * side_m}, .speed_mps = speed};
      const SingleTrackState end = track_x_axis(start, 20.0 + 200.0 / speed);
      EXPECT_NEAR(end.pose.y_m, 0.0, 0.01) << speed << " m/s";
      EXPECT_NEAR(end.pose.heading_rad, 0.0, 0.01);
    }
  }
}

// Straight ahead, the front axle's offset obeys ė = −v sin(atan(k e/L_x)) ≈ −(v k / L_x) e.
TEST(Stanley, OffsetDecaysWithLookForwardDistanceOverGain) {
  const double speed = 10.0, distance_m = 20.0;
  const double gain = cross_track_gain(speed), ahead = look_forward_m(speed);
  const double aligned = -std::atan(gain * 0.1 / ahead);  // the wheels point along the x axis
  SingleTrackState state{.pose = {0.0, 0.0, aligned}, .speed_mps = speed};
  state.pose.y_m = 0.1 - kVehicle.wheelbase_m * std::sin(aligned);
  const SingleTrackState end = track_x_axis(state, distance_m / speed);
  const double front_y = (end.pose * Eigen::Vector2d(kVehicle.wheelbase_m, 0.0)).y();
  EXPECT_NEAR(front_y, 0.1 * std::exp(-gain * distance_m / ahead), 0.002);
}

}  // namespace
}  // namespace roadbed::control
