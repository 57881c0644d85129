#include "roadbed/control/cruise_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "roadbed/control/lower_controller.h"

namespace roadbed::control {
namespace {

constexpr double kCycle_s = 0.1;

struct Car {
  double position_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;

  // Fine steps of the actuator's lag, the speed never below zero.
  void drive(double command_mps2) {
    for (int i = 0; i < 10; ++i) {
      position_m += 0.1 * kCycle_s * speed_mps;
      speed_mps = std::max(0.0, speed_mps + 0.1 * kCycle_s * acceleration_mps2);
      acceleration_mps2 = actuate(acceleration_mps2, command_mps2, 0.1 * kCycle_s);
    }
  }
};

constexpr SetSpeed kFast{.speed_mps = 40.0};

LeadMeasurement measure(const Car& own, double lead_position_m, double lead_speed_mps) {
  return {.gap_m = lead_position_m - own.position_m,
          .relative_speed_mps = lead_speed_mps - own.speed_mps};
}

TEST(CruiseControl, SettlesAtHeadwayTimesSpeedPlusStandstillGap) {
  for (const double lead_mps : {3.0, 10.0, 25.0}) {
    CruiseControl control({});
    Car own{.speed_mps = lead_mps + 2.0};
    double lead_m = 60.0;
    for (int k = 0; k < 1200; ++k, lead_m += kCycle_s * lead_mps) {
      own.drive(control.update(own.speed_mps, own.acceleration_mps2, kFast,
                               measure(own, lead_m, lead_mps)));
    }
    EXPECT_NEAR(lead_m - own.position_m, 1.5 * lead_mps + 5.0, 0.05) << lead_mps << " m/s";
    EXPECT_NEAR(own.speed_mps, lead_mps, 0.01);
  }
}

TEST(CruiseControl, HoldsTheSetSpeedWithoutALead) {
  CruiseControl control({});
  Car own{.speed_mps = 5.0};
  double fastest = 0.0;
  for (int k = 0; k < 400; ++k) {
    own.drive(control.update(own.speed_mps, own.acceleration_mps2, {.speed_mps = 15.0}, {}));
    fastest = std::max(fastest, own.speed_mps);
  }
  EXPECT_NEAR(own.speed_mps, 15.0, 1e-3);
  EXPECT_LT(fastest, 15.3);
}

TEST(CruiseControl, HoldsTheSetSpeedWhenTheLeadIsFar) {
  CruiseControl control({});
  Car own{.speed_mps = 15.0};
  const double command =
      control.update(own.speed_mps, 0.0, {.speed_mps = 15.0}, LeadMeasurement{.gap_m = 200.0});
  EXPECT_NEAR(command, 0.0, 1e-12);
}

TEST(CruiseControl, FollowsAFallingSetSpeedWithoutLagInTheAcceleration) {
  CruiseControl control({});
  Car own{.speed_mps = 20.0, .acceleration_mps2 = -1.5};
  for (int k = 0; k < 80; ++k) {
    const double set_mps = 20.0 - 1.5 * kCycle_s * k;
    own.drive(control.update(own.speed_mps, own.acceleration_mps2,
                             {.speed_mps = set_mps, .acceleration_mps2 = -1.5}, {}));
  }
  EXPECT_NEAR(own.speed_mps, 20.0 - 1.5 * kCycle_s * 80, 0.02);
}

TEST(CruiseControl, NeverAsksForMoreThanAQuarterOfGravity) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> gap(-10, 200), speed(0, 40), acceleration(-8, 8);
  CruiseControl control({});
  for (int k = 0; k < 10'000; ++k) {
    const double command = control.update(
        speed(random), acceleration(random), {.speed_mps = speed(random)},
        LeadMeasurement{.gap_m = gap(random), .relative_speed_mps = speed(random) - 20});
    EXPECT_LE(std::abs(command), 0.25 * 9.81);
  }
}

TEST(CruiseControl, EachErrorAsksForTheOppositeAcceleration) {
  const auto command = [](double gap_m, double relative_mps, double acceleration_mps2) {
    return CruiseControl({}).update(
        10.0, acceleration_mps2, kFast,
        LeadMeasurement{.gap_m = gap_m, .relative_speed_mps = relative_mps});
  };
  EXPECT_NEAR(command(20.0, 0.0, 0.0), 0.0, 1e-12);  // 1.5 s · 10 m/s + 5 m
  EXPECT_LT(command(19.0, 0.0, 0.0), -0.5);
  EXPECT_GT(command(21.0, 0.0, 0.0), 0.5);
  EXPECT_LT(command(20.0, -1.0, 0.0), -0.5);
  EXPECT_GT(command(20.0, 1.0, 0.0), 0.5);
  EXPECT_LT(command(20.0, 0.0, 1.0), -0.5);
}

// The law that a Kalman filter exists for: its estimate is nearer to the truth than what it is fed.
TEST(CruiseControl, EstimateIsNearerToTheTruthThanTheMeasurement) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  CruiseControl control({});
  Car own{.speed_mps = 12.0};
  double lead_m = 25.0, lead_mps = 12.0;
  double squared_raw = 0.0, squared_estimate = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double truth = own.speed_mps * 1.5 + 5.0 - (lead_m - own.position_m);
    LeadMeasurement seen = measure(own, lead_m, lead_mps);
    seen.gap_m += 0.5 * normal(random);
    seen.relative_speed_mps += 0.2 * normal(random);
    const double command =
        control.update(own.speed_mps, own.acceleration_mps2 + 0.1 * normal(random), kFast, seen);
    if (k > 100) {
      squared_raw += std::pow(own.speed_mps * 1.5 + 5.0 - seen.gap_m - truth, 2);
      squared_estimate += std::pow((*control.estimate())[0] - truth, 2);
    }
    own.drive(command);
    lead_m += kCycle_s * lead_mps;
    lead_mps += kCycle_s * std::sin(0.02 * k);
  }
  EXPECT_LT(squared_estimate, 0.1 * squared_raw);
}

TEST(CruiseControl, StartsAnewOnAnotherLeadAndForgetsALostOne) {
  CruiseControl control({});
  const auto follow = [&](double gap_m) {
    control.update(10.0, 0.0, kFast, LeadMeasurement{.gap_m = gap_m});
    return control.restarted();
  };
  EXPECT_TRUE(follow(20.0));
  EXPECT_FALSE(follow(20.3));
  EXPECT_TRUE(follow(11.0));  // a vehicle cut in
  EXPECT_DOUBLE_EQ((*control.estimate())[0], 9.0);
  EXPECT_FALSE(follow(11.0));
  control.update(10.0, 0.0, kFast, {});
  EXPECT_FALSE(control.estimate());
  EXPECT_TRUE(follow(11.0));
}

// A vehicle that is braked at 6 m/s² by another layer, behind a lead that drives on.
int restarts_while_braked(bool tells) {
  CruiseControl control({});
  double speed_mps = 25.0, acceleration_mps2 = 0.0, gap_m = 30.0;
  int restarts = 0;
  for (int k = 0; k < 20; ++k) {
    control.observe(speed_mps, acceleration_mps2,
                    LeadMeasurement{.gap_m = gap_m, .relative_speed_mps = 25.0 - speed_mps});
    restarts += k > 0 && control.restarted() ? 1 : 0;
    control.command(speed_mps, acceleration_mps2, {.speed_mps = 25.0});
    if (tells) control.sent(-6.0);
    for (int i = 0; i < 10; ++i) {
      acceleration_mps2 = actuate(acceleration_mps2, -6.0, 0.01);
      gap_m += 0.01 * (25.0 - speed_mps);
      speed_mps += 0.01 * acceleration_mps2;
    }
  }
  return restarts;
}

TEST(CruiseControl, FilterPredictsWithTheCommandThatWasSent) {
  EXPECT_EQ(restarts_while_braked(true), 0);
  EXPECT_GT(restarts_while_braked(false), 5);
}

TEST(CruiseControl, EstimatedLeadIsTheOneThatStartedTheFilter) {
  CruiseControl control({});
  EXPECT_FALSE(control.lead());
  control.observe(13.0, 0.5, LeadMeasurement{.gap_m = 31.0, .relative_speed_mps = -2.0});
  EXPECT_NEAR(control.lead()->gap_m, 31.0, 1e-12);
  EXPECT_NEAR(control.lead()->relative_speed_mps, -2.0, 1e-12);
}

}  // namespace
}  // namespace roadbed::control
