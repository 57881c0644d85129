#include "roadbed/planning/reference/speed_ceiling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace roadbed::planning {
namespace {

std::vector<double> random_caps(std::mt19937& random) {
  std::uniform_real_distribution<double> cap(0.0, 20.0);
  std::vector<double> caps(100);
  for (double& c : caps) c = cap(random);
  return caps;
}

TEST(SpeedCeiling, IsTheGreatestThatKeepsCapsAndDeceleration) {
  std::mt19937 random(5);
  constexpr double kStep = 0.5, kBraking = 1.5;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const std::vector<double> caps = random_caps(random);
    const SpeedCeiling ceiling(caps, kStep, kBraking);
    for (std::size_t i = 0; i < caps.size(); ++i) {
      // Brute force: every cap ahead, met after braking from here.
      double expected = std::numeric_limits<double>::infinity();
      for (std::size_t j = i; j < caps.size(); ++j) {
        const double distance = kStep * static_cast<double>(j - i);
        expected = std::min(expected, std::sqrt(caps[j] * caps[j] + 2 * kBraking * distance));
      }
      EXPECT_NEAR(ceiling.at(kStep * static_cast<double>(i)).speed_mps, expected, 1e-9);
    }
  }
}

TEST(SpeedCeiling, AccelerationIsTheRateAtWhichTheSpeedFalls) {
  const SpeedCeiling ceiling({10.0, 10.0, 9.0, 8.0, 12.0}, 20.0, 1.5);
  for (double s = 21.0; s < 60.0; s += 3.0) {
    const double dt = 1e-6, v = ceiling.at(s).speed_mps;
    const double rate = (ceiling.at(s + v * dt).speed_mps - v) / dt;
    EXPECT_NEAR(ceiling.at(s).acceleration_mps2, rate, 1e-5);
  }
  EXPECT_EQ(ceiling.at(70.0).acceleration_mps2, 0.0);  // the speed rises
  EXPECT_EQ(ceiling.at(-5.0).speed_mps, 10.0);
  EXPECT_EQ(ceiling.at(1000.0).speed_mps, 12.0);
}

TEST(SpeedCeiling, StoppingSpeedLeadsToTheStopWithoutPassingIt) {
  double distance = 60.0;
  for (int k = 0; k < 40'000; ++k) {
    distance -= 0.001 * stopping_speed(distance, 1.5).speed_mps;
    EXPECT_GE(distance, 0.0);
  }
  EXPECT_LT(distance, 1e-6);
  EXPECT_EQ(stopping_speed(-1.0, 1.5).speed_mps, 0.0);
}

TEST(SpeedCeiling, StoppingTakesTheDecelerationItSaysAndNeverMore) {
  for (double distance = 0.05; distance < 60.0; distance += 0.05) {
    const SpeedTarget target = stopping_speed(distance, 1.5);
    const double dt = 1e-6, later = distance - dt * target.speed_mps;
    const double rate = (stopping_speed(later, 1.5).speed_mps - target.speed_mps) / dt;
    EXPECT_NEAR(target.acceleration_mps2, rate, 1e-5) << distance;
    EXPECT_GE(target.acceleration_mps2, -1.5);
  }
}

TEST(SpeedCeiling, UnusableNumbersAreRefused) {
  EXPECT_THROW(SpeedCeiling({1.0}, 0.5, 1.5), std::invalid_argument);
  EXPECT_THROW(SpeedCeiling({1.0, -1.0}, 0.5, 1.5), std::invalid_argument);
  EXPECT_THROW(SpeedCeiling({1.0, std::nan("")}, 0.5, 1.5), std::invalid_argument);
  EXPECT_THROW(SpeedCeiling({1.0, 1.0}, 0.0, 1.5), std::invalid_argument);
  EXPECT_THROW(SpeedCeiling({1.0, 1.0}, 0.5, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
