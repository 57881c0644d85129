#include "roadbed/control/single_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "roadbed/tests/support/real_data.h"

namespace roadbed::control {
namespace {

constexpr double kFineStep_s = 0.001;

/// CommonRoad's reference input: steering rate 0.05 sin t rad/s; 1 m/s² for 3 s, then −0.5.
DynamicState sent_until(double end_s, const DynamicVehicle& vehicle) {
  DynamicState state{.speed_mps = 10.0};
  for (double t = 0.0; t < end_s - 0.5 * kFineStep_s; t += kFineStep_s) {
    state = step(state,
                 {.acceleration_mps2 = t < 3.0 - 0.5 * kFineStep_s ? 1.0 : -0.5,
                  .steering_rate_radps = 0.05 * std::sin(t + 0.5 * kFineStep_s)},
                 kFineStep_s, vehicle);
  }
  return state;
}

// Ends after 10 s as commonroad-vehicle-models 3.0.2 has them, integrated to 1e-11.
TEST(DynamicSingleTrack, AgreesWithCommonRoadOnVehiclesOneToThree) {
  struct End {
    int vehicle;
    double x_m, y_m, heading, yaw_rate, slip;
  };
  const End ends[] = {
      {1, 29.44542073, 79.72757832, 2.505939848, 0.3737825251, 0.04188512395},
      {2, 38.35937334, 79.93885563, 2.322558598, 0.3464432909, 0.03577209554},
      {3, 33.95087733, 79.7134174, 2.422811976, 0.3631866223, 0.03340313241},
  };
  for (const End& end : ends) {
    const DynamicState state = sent_until(10.0, common_road_vehicle(end.vehicle));
    EXPECT_NEAR(state.pose.x_m, end.x_m, 1e-4) << "vehicle " << end.vehicle;
    EXPECT_NEAR(state.pose.y_m, end.y_m, 1e-4);
    EXPECT_NEAR(state.pose.heading_rad, end.heading, 1e-6);
    EXPECT_NEAR(state.speed_mps, 9.5, 1e-9);
    EXPECT_NEAR(state.yaw_rate_radps, end.yaw_rate, 1e-6);
    EXPECT_NEAR(state.slip_rad, end.slip, 1e-6);
  }
}

TEST(DynamicSingleTrack, FollowsCommonRoadsRunAtEveryMoment) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::ifstream file(folder / "control/cr_st_bmw320i.csv");
  std::string line;
  std::getline(file, line);  // the names of the columns
  int rows = 0;
  for (; std::getline(file, line); ++rows) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream row(line);
    double t, x, y, delta, v, psi, yaw_rate, slip;
    ASSERT_TRUE(row >> t >> x >> y >> delta >> v >> psi >> yaw_rate >> slip) << line;
    if (rows % 10 != 0) continue;
    const DynamicState state = sent_until(t, common_road_vehicle(2));
    EXPECT_NEAR(state.pose.x_m, x, 1e-4) << "t = " << t;
    EXPECT_NEAR(state.pose.y_m, y, 1e-4);
    EXPECT_NEAR(state.steering_rad, delta, 1e-6);
    EXPECT_NEAR(state.yaw_rate_radps, yaw_rate, 1e-5);
    EXPECT_NEAR(state.slip_rad, slip, 1e-5);
  }
  EXPECT_GT(rows, 50);
}

TEST(DynamicSingleTrack, RollsWithoutSlipBelowATenthOfAMetrePerSecond) {
  const DynamicVehicle vehicle = common_road_vehicle(2);
  DynamicState state{.speed_mps = 0.08, .steering_rad = 0.3};
  for (int k = 0; k < 100; ++k) state = step(state, {}, 0.01, vehicle);
  const double L = vehicle.front_axle_m + vehicle.rear_axle_m;
  const double beta = std::atan(vehicle.rear_axle_m * std::tan(0.3) / L);
  EXPECT_NEAR(state.pose.heading_rad, 0.08 * std::cos(beta) * std::tan(0.3) / L, 1e-9);
}

// Slip is stiff at low speed: steps of 10 ms then must be as good as steps of 0.1 ms.
TEST(DynamicSingleTrack, CrawlsStablyAtLongSteps) {
  const DynamicVehicle vehicle = common_road_vehicle(2);
  for (const double speed : {0.11, 0.2, 0.5, 2.0}) {
    DynamicState coarse{.speed_mps = speed}, fine = coarse;
    for (int k = 0; k < 500; ++k) {
      const SingleTrackInput input{.steering_rate_radps = 0.1 * std::cos(0.02 * k)};
      coarse = step(coarse, input, 0.01, vehicle);
      for (int i = 0; i < 100; ++i) fine = step(fine, input, 0.0001, vehicle);
    }
    EXPECT_NEAR(coarse.pose.x_m, fine.pose.x_m, 1e-4) << speed << " m/s";
    EXPECT_NEAR(coarse.pose.y_m, fine.pose.y_m, 1e-4) << speed << " m/s";
    EXPECT_NEAR(coarse.slip_rad, fine.slip_rad, 1e-4) << speed << " m/s";
  }
}

TEST(DynamicSingleTrack, BrakesToStandstillAndThereAreThreeVehicles) {
  DynamicState state{.speed_mps = 2.0};
  for (int k = 0; k < 300; ++k) {
    state = step(state, {.acceleration_mps2 = -2.0}, 0.01, common_road_vehicle(1));
  }
  EXPECT_NEAR(state.speed_mps, 0.0, 1e-12);
  EXPECT_THROW(common_road_vehicle(0), std::invalid_argument);
  EXPECT_THROW(common_road_vehicle(4), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::control
