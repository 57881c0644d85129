#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/control/cruise_control.h"
#include "roadbed/control/cruise_design.h"
#include "roadbed/control/lower_controller.h"

namespace roadbed::control {
namespace {

constexpr int kDelaySteps = 2;
constexpr SetSpeed kNoLimit{.speed_mps = 60.0};

/// A follower by the sampled model itself, its command two steps late.
class SampledFollower {
 public:
  SampledFollower(const CruiseOptions& options, double speed_mps)
      : options_(options), control_(options), lead_mps_(speed_mps), late_(kDelaySteps, 0.0) {}

  double speed_mps() const { return lead_mps_ - x_[1]; }
  double acceleration_mps2() const { return x_[2]; }

  void advance(double lead_acceleration_mps2) {
    const double gap_m = options_.headway_s * speed_mps() + options_.standstill_gap_m - x_[0];
    late_.push_back(control_.update(speed_mps(), x_[2], kNoLimit,
                                    LeadMeasurement{.gap_m = gap_m, .relative_speed_mps = x_[1]}));
    const CruiseModel& model = control_.design().model;
    x_ = model.A * x_ + model.B * late_.front() + model.G * lead_acceleration_mps2;
    late_.pop_front();
    lead_mps_ += options_.step_s * lead_acceleration_mps2;
  }

 private:
  CruiseOptions options_;
  CruiseControl control_;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  double lead_mps_;
  std::deque<double> late_;
};

/// Amplitude of the follower's speed over that of its lead's, once settled.
double settled_gain(const CruiseOptions& options, double radps) {
  constexpr double kAmplitude = 0.2;
  const double period_s = 2.0 * std::numbers::pi / radps, step_s = options.step_s;
  SampledFollower follower(options, 20.0);
  const auto settled = static_cast<int>((60.0 + 5.0 * period_s) / step_s);
  const auto end = settled + static_cast<int>(4.0 * period_s / step_s);
  double squares = 0.0, lead_squares = 0.0, mean = 0.0, lead_mean = 0.0;
  for (int k = 0; k < end; ++k) {
    const double lead_mps = 20.0 + kAmplitude * std::sin(radps * step_s * k);
    const double next_mps = 20.0 + kAmplitude * std::sin(radps * step_s * (k + 1));
    if (k >= settled) {
      const double off = follower.speed_mps() - 20.0, lead_off = lead_mps - 20.0;
      squares += off * off, lead_squares += lead_off * lead_off;
      mean += off, lead_mean += lead_off;
    }
    follower.advance((next_mps - lead_mps) / step_s);
  }
  const double n = end - settled;
  return std::sqrt((squares - mean * mean / n) / (lead_squares - lead_mean * lead_mean / n));
}

TEST(Platoon, GainFromLeadToFollowerIsNotAboveOneWithFilterAndDelay) {
  for (int delay = 0; delay <= 3; ++delay) {
    EXPECT_LE(loop_string_gain(design_cruise({}), 0.1, delay).gain, 1.001) << delay << " steps";
  }
  for (const double hertz : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0}) {
    EXPECT_LE(settled_gain({}, 2.0 * std::numbers::pi * hertz), 1.001) << hertz << " Hz";
  }
}

// The reason why it has no weight by default: the command's weight counts it already.
TEST(Platoon, WeightOnTheOwnAccelerationDampsNothing) {
  double last = 0.0;
  for (const double weight : {0.0, 0.5, 1.0, 2.0}) {
    const CruiseOptions options{.state_weights = {1.0, 1.0, weight}};
    const StringGain gain = loop_string_gain(design_cruise(options), options.step_s, kDelaySteps);
    EXPECT_GT(gain.gain, last) << weight;
    last = gain.gain;
  }
  EXPECT_EQ(CruiseOptions{}.state_weights[2], 0.0);
}

TEST(Platoon, GainOfTheLoopIsTheAmplitudeOfASineThatSettled) {
  const CruiseOptions sluggish{.state_weights = {0.04, 1.0, 0.5}};  // amplifies, with its filter
  const CruiseDesign design = design_cruise(sluggish);
  const StringGain largest = loop_string_gain(design, sluggish.step_s, kDelaySteps);
  EXPECT_GT(largest.gain, 1.005);
  EXPECT_LE(string_gain(design, sluggish.step_s).gain, 1.001);  // without filter it would not
  EXPECT_NEAR(settled_gain(sluggish, largest.at_radps), largest.gain, 5e-4);
  EXPECT_THROW(loop_string_gain(design, 0.1, -1), std::invalid_argument);
}

/// A car of a platoon: gap measured to the one before it, the actuator's lag, the command late.
struct Member {
  CruiseControl control{{}};
  double position_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;
  std::deque<double> late = std::deque<double>(kDelaySteps, 0.0);

  void advance(double lead_position_m, double lead_speed_mps) {
    late.push_back(
        control.update(speed_mps, acceleration_mps2, kNoLimit,
                       LeadMeasurement{.gap_m = lead_position_m - position_m,
                                       .relative_speed_mps = lead_speed_mps - speed_mps}));
    for (int i = 0; i < 10; ++i) {
      acceleration_mps2 = actuate(acceleration_mps2, late.front(), 0.01);
      position_m += 0.01 * speed_mps;
      speed_mps = std::max(0.0, speed_mps + 0.01 * acceleration_mps2);
    }
    late.pop_front();
  }
};

struct PlatoonRun {
  std::vector<double> peak_mps;  ///< largest speed deviation of each, the lead first
  double least_gap_m = 1e9;
  double saturated_share = 0.0;
};

/// The lead brakes, holds its speed until `hold_s`, and speeds up again at 2 m/s².
PlatoonRun brake_down_a_platoon(double deceleration_mps2, double duration_s, double hold_s) {
  constexpr double kUsual_mps = 25.0;
  std::vector<Member> cars(10);
  for (std::size_t i = 0; i < cars.size(); ++i) {
    cars[i].speed_mps = kUsual_mps;
    cars[i].position_m = -static_cast<double>(i + 1) * (1.5 * kUsual_mps + 5.0);
  }
  double lead_m = 0.0, lead_mps = kUsual_mps;
  PlatoonRun run{.peak_mps = std::vector<double>(cars.size() + 1, 0.0)};
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.1 * k;
    const bool speeds_up = t >= hold_s && lead_mps < kUsual_mps - 1e-9;
    const double a = t < duration_s - 1e-9 ? -deceleration_mps2 : (speeds_up ? 2.0 : 0.0);
    double before_m = lead_m, before_mps = lead_mps;
    lead_m += 0.1 * (lead_mps + 0.05 * a);
    lead_mps += 0.1 * a;
    run.peak_mps[0] = std::max(run.peak_mps[0], std::abs(lead_mps - kUsual_mps));
    for (std::size_t i = 0; i < cars.size(); ++i) {
      run.least_gap_m = std::min(run.least_gap_m, before_m - cars[i].position_m);
      const double own_m = cars[i].position_m, own_mps = cars[i].speed_mps;
      cars[i].advance(before_m, before_mps);
      before_m = own_m, before_mps = own_mps;
      run.peak_mps[i + 1] = std::max(run.peak_mps[i + 1], std::abs(cars[i].speed_mps - kUsual_mps));
      run.saturated_share += std::abs(cars[i].late.back()) >= 0.25 * 9.81 ? 5e-5 : 0.0;
    }
  }
  return run;
}

// Harder than ¼ g, so that the followers saturate: −6 m/s² from 25 to 13 m/s, and on again.
TEST(Platoon, PeakSpeedDeviationDoesNotGrowDownTenCarsBehindHardBraking) {
  const PlatoonRun run = brake_down_a_platoon(6.0, 2.0, 2.0);
  EXPECT_NEAR(run.peak_mps[0], 12.0, 1e-9);
  EXPECT_GT(run.saturated_share, 0.004);
  EXPECT_GT(run.least_gap_m, 15.0);
  for (std::size_t i = 1; i < run.peak_mps.size(); ++i) {
    EXPECT_LE(run.peak_mps[i], run.peak_mps[i - 1]) << "car " << i;
  }
}

// Behind a lead that stays at its new speed the first follower, held to ¼ g, has to make up for
// the gap that it lost; behind it the peak shrinks again.
TEST(Platoon, OnlyTheFirstFollowerPassesALeadThatBrakesHardAndStaysSlow) {
  const PlatoonRun run = brake_down_a_platoon(4.0, 3.0, 40.0);
  EXPECT_LE(run.peak_mps[1], 1.25 * run.peak_mps[0]);
  for (std::size_t i = 2; i < run.peak_mps.size(); ++i) {
    EXPECT_LE(run.peak_mps[i], run.peak_mps[i - 1] + 1e-6) << "car " << i;
  }
}

TEST(CruiseControl, RidesThroughMeasurementsThatDropOut) {
  std::mt19937 random(20261121);
  Member car{.speed_mps = 20.0};
  double lead_m = 35.0, worst_mps2 = 0.0;
  for (int k = 0; k < 1200; ++k, lead_m += 2.0) {
    const bool is_seen = random() % 10 >= 3;  // three of ten are lost
    const LeadMeasurement seen{.gap_m = lead_m - car.position_m,
                               .relative_speed_mps = 20.0 - car.speed_mps};
    if (is_seen) {
      car.control.observe(car.speed_mps, car.acceleration_mps2, seen);
    } else {
      car.control.observe_blind(car.speed_mps);
    }
    const double command = car.control.command(car.speed_mps, car.acceleration_mps2, kNoLimit);
    ASSERT_TRUE(car.control.estimate()) << "after " << k << " steps";
    EXPECT_FALSE(k > 0 && car.control.restarted());
    worst_mps2 = std::max(worst_mps2, std::abs(command));
    for (int i = 0; i < 10; ++i) {
      car.acceleration_mps2 = actuate(car.acceleration_mps2, command, 0.01);
      car.position_m += 0.01 * car.speed_mps;
      car.speed_mps += 0.01 * car.acceleration_mps2;
    }
  }
  EXPECT_LT(worst_mps2, 0.1);  // a set speed of 60 m/s would ask for ¼ g
  EXPECT_NEAR(lead_m - car.position_m, 35.0, 0.5);
}

TEST(CruiseControl, ForgetsALeadThatStaysOutOfSightAndTakesItUpAgain) {
  CruiseControl control({});
  const LeadMeasurement near{.gap_m = 20.0};
  control.update(10.0, 0.0, kNoLimit, near);
  for (int k = 0; k < 5; ++k) {
    control.observe_blind(10.0);
    control.command(10.0, 0.0, kNoLimit);
    EXPECT_TRUE(control.estimate()) << k;
  }
  control.observe_blind(10.0);
  EXPECT_FALSE(control.estimate());
  control.update(10.0, 0.0, kNoLimit, near);
  EXPECT_TRUE(control.restarted());
}

TEST(CruiseControl, CutInDoesNotJerk) {
  for (const double gap_m : {25.0, 17.5, 10.0}) {
    CruiseControl control({});
    double own_m = 0.0, own_mps = 20.0, own_mps2 = 0.0, lead_m = 80.0, jerk = 0.0;
    for (int k = 0; k < 600; ++k, lead_m += 2.0) {
      if (k == 100) lead_m = own_m + gap_m;
      const double command = control.update(
          own_mps, own_mps2, {.speed_mps = 20.0},
          LeadMeasurement{.gap_m = lead_m - own_m, .relative_speed_mps = 20.0 - own_mps});
      EXPECT_TRUE(k != 100 || control.restarted());
      for (int i = 0; i < 10; ++i) {
        const double before = own_mps2;
        own_mps2 = actuate(own_mps2, command, 0.01);
        jerk = std::max(jerk, std::abs(own_mps2 - before) / 0.01);
        own_m += 0.01 * own_mps;
        own_mps += 0.01 * own_mps2;
      }
      EXPECT_GT(lead_m, own_m);
    }
    EXPECT_LE(jerk, 4.0 + 1e-9) << gap_m << " m";
    EXPECT_NEAR(lead_m - own_m, 35.0, 0.1);
  }
}

}  // namespace
}  // namespace roadbed::control
