#include "roadbed/control/lower_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace roadbed::control {
namespace {

TEST(Actuator, StepResponseIsThatOfAFirstOrderLag) {
  const ActuatorOptions options{.lag_s = 0.45, .gain = 0.9};
  double acceleration = 0.0;
  for (int k = 1; k <= 300; ++k) {
    acceleration = actuate(acceleration, 2.0, 0.01, options);
    EXPECT_NEAR(acceleration, 0.9 * 2.0 * (1.0 - std::exp(-0.01 * k / 0.45)), 1e-12);
  }
}

TEST(Actuator, TwoHalfStepsAreOneStep) {
  const double half = actuate(actuate(-1.0, 2.0, 0.05), 2.0, 0.05);
  EXPECT_NEAR(half, actuate(-1.0, 2.0, 0.1), 1e-15);
}

TEST(Actuator, LagMustBePositive) {
  EXPECT_THROW(actuate(0.0, 1.0, 0.1, {.lag_s = 0.0}), std::invalid_argument);
  EXPECT_THROW(actuate(0.0, 1.0, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::control
