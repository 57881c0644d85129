#include "roadbed/control/lower_controller.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbed::control {
namespace {

constexpr double kPedalStep_s = 0.001;
constexpr double kOldSpeed_mps = 15.0;

/// Holds its speed on the grade, as before a step.
DrivenState rolling(double grade_rad, const DriveTrain& train) {
  return {.speed_mps = kOldSpeed_mps, .force_N = resistance_N(kOldSpeed_mps, grade_rad, train)};
}

// Paper eq. 25 with K_L = 1: a(t) = a_des (1 − exp(−t / T_L)), whatever the grade.
TEST(Pedals, StepResponseIsThatOfTheFirstOrderLagOnAnyGrade) {
  const DriveTrain train;
  for (const double grade : {-0.06, 0.0, 0.06}) {
    for (const double desired : {-2.0, -0.8, 0.7, 1.5}) {
      PedalController controller(train, 0.0);
      DrivenState state = rolling(grade, train);
      for (int k = 0; k < 3000; ++k) {
        const double expected = desired * (1.0 - std::exp(-kPedalStep_s * k / train.lag_s));
        ASSERT_NEAR(acceleration_mps2(state, grade, train), expected, 0.02)
            << "grade " << grade << ", " << desired << " m/s², " << kPedalStep_s * k << " s";
        const Pedals pedals = controller.update(desired, state.speed_mps, grade);
        state = drive(state, pedals, grade, kPedalStep_s, train);
      }
    }
  }
}

TEST(Pedals, ResistanceIsDragRollingAndTheWeightOnTheGrade) {
  const DriveTrain train{.mass_kg = 1000.0, .drag_area_m2 = 0.5, .rolling_resistance = 0.01};
  EXPECT_NEAR(resistance_N(0.0, 0.0, train), 98.1, 1e-9);
  EXPECT_NEAR(resistance_N(20.0, 0.0, train), 98.1 + 122.5, 1e-9);
  EXPECT_GT(resistance_N(0.0, 0.1, train), 1000.0);
  EXPECT_LT(resistance_N(0.0, -0.1, train), -800.0);
}

TEST(Pedals, NeverBothAndNeverBeyondTheirStops) {
  PedalController controller{DriveTrain{}};
  for (double desired = -15.0; desired < 15.0; desired += 0.1) {
    const Pedals pedals = controller.update(desired, 10.0, 0.02);
    EXPECT_EQ(pedals.throttle * pedals.brake, 0.0);
    EXPECT_GE(std::min(pedals.throttle, pedals.brake), 0.0);
    EXPECT_LE(std::max(pedals.throttle, pedals.brake), 1.0);
  }
}

// A command that trembles around coasting by half the band never moves the foot across.
TEST(Pedals, SmallChangesAroundCoastingDoNotChangeThePedal) {
  const DriveTrain train;
  const double coasting = -resistance_N(10.0, 0.0, train) / train.mass_kg;
  const double half_band = 25.0 / train.mass_kg;
  const auto changes = [&](double band_N) {
    PedalController controller(train, band_N);
    int count = 0;
    bool braked = false;
    for (int k = 0; k < 200; ++k) {
      const Pedals pedals = controller.update(coasting + half_band * std::sin(k), 10.0, 0.0);
      if ((pedals.brake > 0.0) != braked && pedals.brake + pedals.throttle > 0.0) ++count;
      if (pedals.brake + pedals.throttle > 0.0) braked = pedals.brake > 0.0;
    }
    return count;
  };
  EXPECT_EQ(changes(50.0), 0);
  EXPECT_GT(changes(0.0), 50);
}

}  // namespace
}  // namespace roadbed::control
