#include "roadbed/planning/speed/remaining_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::planning {
namespace {

constexpr double kLayer_s = 0.8, kWanted_mps = 13.0;
constexpr int kLayers = 15;

PathProfile way_of_one_speed() {
  PathProfile way;
  for (int i = 0; i <= 200; ++i) {
    way.ahead_m.push_back(i);
    way.station_m.push_back(i);
    way.body.emplace_back();
    way.wanted_mps.push_back(kWanted_mps);
    way.most_mps.push_back(60.0);
  }
  return way;
}

/// A drive in steps of 0.1 ms.
struct Drive {
  double ahead_m = 0.0, speed_mps, acceleration_mps2;

  void go_on(double command_mps2, double lag_s) {
    constexpr double kStep_s = 1e-4;
    for (double t_s = 0.0; t_s < kLayer_s - 0.5 * kStep_s; t_s += kStep_s) {
      const double before_mps = speed_mps;
      acceleration_mps2 += kStep_s / lag_s * (command_mps2 - acceleration_mps2);
      speed_mps = std::max(0.0, speed_mps + kStep_s * acceleration_mps2);
      if (speed_mps == 0.0) acceleration_mps2 = 0.0;
      ahead_m += 0.5 * kStep_s * (before_mps + speed_mps);
    }
  }
};

double cost_of(double speed_mps) {
  const double missing = (kWanted_mps - speed_mps) / kWanted_mps;
  return kLayer_s * missing * missing;
}

// Each drive ends where the path ends, so that the bound is as large as it can be for that drive.
TEST(RemainingCost, NoDriveThatStaysBeforeTheEndCostsLess) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> speed(0.0, 13.0), acceleration(-2.0, 2.0),
      steady(-0.4, 0.4), command(-1.0, 1.0);
  const PathProfile way = way_of_one_speed();
  const StGraph nothing(way, TrafficBodies{}, 0.0);
  const SpeedSearchOptions options;
  double least_ratio = 1e9;
  for (int i = 0; i < 300; ++i) {
    const double start_mps = speed(random), start_mps2 = acceleration(random);
    Drive drive{.speed_mps = start_mps, .acceleration_mps2 = start_mps2};
    const double bias = steady(random), spread = i % 3 == 0 ? 2.0 : 0.3;
    double cost = 0.0;
    for (int layer = 0; layer < kLayers; ++layer) {
      const double wished = bias + spread * command(random);
      drive.go_on(std::clamp(wished, options.least_mps2, options.most_mps2),
                  options.actuator_lag_s);
      cost += cost_of(std::min(drive.speed_mps, kWanted_mps));
    }
    const SpeedSearchQuestion question{
        .profile = way, .occupancy = nothing, .end_m = drive.ahead_m, .goals = {}};
    const RemainingCost remaining(question, options, kLayer_s, kLayers * kLayer_s);
    const double bound = remaining.before_end({0.0, 0.0, start_mps, start_mps2});
    EXPECT_LE(bound, cost + 1e-3) << "drive " << i;
    if (bound > 0.0) least_ratio = std::min(least_ratio, cost / bound);
  }
  EXPECT_LT(least_ratio, 1.25);  // it is of use
}

TEST(RemainingCost, NothingIsForeseenWhereTheEndIsFar) {
  const PathProfile way = way_of_one_speed();
  const StGraph nothing(way, TrafficBodies{}, 0.0);
  const SpeedSearchQuestion question{
      .profile = way, .occupancy = nothing, .end_m = 200.0, .goals = {}};
  const SpeedSearchOptions options;
  const RemainingCost remaining(question, options, kLayer_s, kLayers * kLayer_s);
  EXPECT_EQ(remaining.before_end({0.0, 0.0, 13.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace roadbed::planning
