#include "roadbed/control/single_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "roadbed/tests/control/default_vehicle.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::control {
namespace {

SingleTrackState drive(SingleTrackState state, const SingleTrackInput& input, double step_s,
                       int steps) {
  for (int k = 0; k < steps; ++k) state = step(state, input, step_s, kVehicle);
  return state;
}

TEST(SingleTrack, ConstantSteeringDrivesACircle) {
  const double steering = 0.2, radius = kVehicle.wheelbase_m / std::tan(steering);
  const SingleTrackState end = drive({.speed_mps = 5.0, .steering_rad = steering}, {}, 0.01, 1000);
  const double angle = 5.0 * 10.0 / radius;
  EXPECT_NEAR(end.pose.x_m, radius * std::sin(angle), 1e-9);
  EXPECT_NEAR(end.pose.y_m, radius * (1.0 - std::cos(angle)), 1e-9);
  EXPECT_NEAR(end.pose.heading_rad, angle, 1e-10);
}

// CommonRoad's own model and integrator: steering rate 0.05 sin t rad/s; 1 m/s² for 3 s, then −0.5.
TEST(SingleTrack, AgreesWithCommonRoadsKinematicModel) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::ifstream file(folder / "control/cr_ks_bmw320i.csv");
  std::string line;
  std::getline(file, line);  // the names of the columns
  SingleTrackState state{.speed_mps = 10.0};
  double t = 0.0;
  int rows = 0;
  constexpr double kStep_s = 0.001;
  while (std::getline(file, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream row(line);
    double row_t, x, y, delta, v, psi;
    ASSERT_TRUE(row >> row_t >> x >> y >> delta >> v >> psi) << line;
    for (; t < row_t - 0.5 * kStep_s; t += kStep_s) {
      state = step(state,
                   {.acceleration_mps2 = t < 3.0 - 0.5 * kStep_s ? 1.0 : -0.5,
                    .steering_rate_radps = 0.05 * std::sin(t + 0.5 * kStep_s)},
                   kStep_s, kVehicle);
    }
    EXPECT_NEAR(state.pose.x_m, x, 1e-5) << "t = " << row_t;
    EXPECT_NEAR(state.pose.y_m, y, 1e-5);
    EXPECT_NEAR(state.pose.heading_rad, psi, 1e-6);
    EXPECT_NEAR(state.speed_mps, v, 1e-6);
    EXPECT_NEAR(state.steering_rad, delta, 1e-6);
    ++rows;
  }
  EXPECT_GT(rows, 50);
}

TEST(SingleTrack, HalvingTheStepShrinksTheErrorSixteenfold) {
  const SingleTrackInput input{.acceleration_mps2 = 1.0, .steering_rate_radps = 0.1};
  const SingleTrackState start{.speed_mps = 8.0, .steering_rad = -0.2};
  const auto end_x = [&](int steps) { return drive(start, input, 4.0 / steps, steps).pose.x_m; };
  const double truth = end_x(4096);
  const double ratio = (end_x(16) - truth) / (end_x(32) - truth);
  EXPECT_NEAR(ratio, 16.0, 3.0);
}

TEST(SingleTrack, BrakingEndsAtStandstillAfterTheBrakingDistance) {
  const SingleTrackState end = drive({.speed_mps = 9.0}, {.acceleration_mps2 = -2.0}, 0.07, 200);
  EXPECT_EQ(end.speed_mps, 0.0);
  EXPECT_NEAR(end.pose.x_m, 9.0 * 9.0 / (2.0 * 2.0), 1e-9);
}

TEST(SingleTrack, SteeringKeepsToItsRateAndAngle) {
  const SingleTrackState early = drive({.speed_mps = 1.0}, {.steering_rate_radps = 5.0}, 0.01, 100);
  EXPECT_NEAR(early.steering_rad, 0.4, 1e-12);
  const SingleTrackState late = drive({.speed_mps = 1.0}, {.steering_rate_radps = -5.0}, 0.01, 900);
  EXPECT_NEAR(late.steering_rad, -1.066, 1e-12);
}

TEST(SingleTrack, WheelsTurnAtStandstillAndThePoseStays) {
  const SingleTrackState end =
      drive({}, {.acceleration_mps2 = -1.0, .steering_rate_radps = 0.1}, 0.1, 10);
  EXPECT_NEAR(end.steering_rad, 0.1, 1e-12);
  EXPECT_EQ(end.pose.x_m, 0.0);
  EXPECT_EQ(end.pose.heading_rad, 0.0);
}

}  // namespace
}  // namespace roadbed::control
