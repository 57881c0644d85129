#include "roadbed/planning/tracking/motion_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning {
namespace {

constexpr double kStep_s = 0.1;

/// A body that turns and speeds up with white jerk and turn acceleration, in steps of 1 ms.
struct Body {
  double t_s = 0.0, x_m = 0.0, y_m = 0.0, heading_rad = 0.3, speed_mps = 9.0;
  double acceleration_mps2 = 0.0, turn_rate_radps = 0.0;

  template <class Random>
  void go_on(double duration_s, double jerk, double turn_acceleration, Random& random) {
    std::normal_distribution<double> normal;
    constexpr double dt = 1e-3;
    for (int i = 0; i < std::lround(duration_s / dt); ++i) {
      x_m += dt * speed_mps * std::cos(heading_rad);
      y_m += dt * speed_mps * std::sin(heading_rad);
      heading_rad += dt * turn_rate_radps;
      speed_mps += dt * acceleration_mps2;
      acceleration_mps2 += -dt / 2.0 * acceleration_mps2 + jerk * std::sqrt(dt) * normal(random);
      turn_rate_radps += turn_acceleration * std::sqrt(dt) * normal(random);
      t_s += dt;
    }
  }

  MeasuredMotion exactly() const { return {t_s, {x_m, y_m, heading_rad}, speed_mps}; }

  template <class Random>
  MeasuredMotion measured(const ObjectNoise& noise, Random& random) const {
    std::normal_distribution<double> normal;
    return {t_s,
            {x_m + noise.position_m * normal(random), y_m + noise.position_m * normal(random),
             heading_rad + noise.heading_rad * normal(random)},
            speed_mps + noise.speed_mps * normal(random)};
  }
};

TEST(MotionFilter, FollowsABodyThatTurnsSteadily) {
  std::mt19937_64 random(1);
  Body body{.turn_rate_radps = 0.3};
  MotionFilter filter(body.exactly(), {});
  for (int k = 0; k < 50; ++k) {
    body.go_on(kStep_s, 0.0, 0.0, random);
    filter.predict(body.t_s);
    filter.update(body.exactly());
  }
  const SeenMotion seen = filter.state();
  EXPECT_NEAR(seen.pose.x_m, body.x_m, 0.02);
  EXPECT_NEAR(seen.pose.y_m, body.y_m, 0.02);
  EXPECT_NEAR(geometry::wrap_angle(seen.pose.heading_rad - body.heading_rad), 0.0, 0.002);
  EXPECT_NEAR(seen.curvature_per_m, 0.3 / 9.0, 0.0005);
  EXPECT_NEAR(seen.acceleration_mps2, 0.0, 0.05);
}

TEST(MotionFilter, KnowsAnAcceleration) {
  MotionFilter filter({0.0, {0, 0, 0}, 10.0}, {});
  for (int k = 1; k <= 20; ++k) {
    const double t = kStep_s * k;
    filter.predict(t);
    filter.update({t, {10.0 * t - 1.5 * t * t, 0, 0}, 10.0 - 3.0 * t});
  }
  EXPECT_NEAR(filter.state().acceleration_mps2, -3.0, 0.3);
  EXPECT_NEAR(filter.state().speed_mps, 4.0, 0.05);
}

// Measured by what it believes of itself, a filter's misfits are χ² of four degrees of freedom: a
// wrong sign or factor of the motion, of its derivatives or of the noise makes them larger or less.
TEST(MotionFilter, IsAsSureAsItMayBe) {
  const ObjectNoise noise{.position_m = 0.2, .heading_rad = 0.03, .speed_mps = 0.3};
  std::mt19937_64 random(7);
  double misfits = 0.0;
  int count = 0;
  for (int drive = 0; drive < 300; ++drive) {
    Body body;
    MotionFilter filter(body.measured(noise, random), noise);
    for (int k = 0; k < 40; ++k) {
      body.go_on(kStep_s, 3.0, 0.5, random);
      if (body.speed_mps < 3.0) break;
      filter.predict(body.t_s);
      const MeasuredMotion measured = body.measured(noise, random);
      if (k >= 20) misfits += filter.misfit(measured), ++count;
      filter.update(measured);
    }
  }
  ASSERT_GT(count, 3000);
  EXPECT_NEAR(misfits / count, 4.0, 0.15);
}

TEST(MotionFilter, KnowsPlacesBetterThanTheyAreMeasured) {
  const ObjectNoise noise{.position_m = 0.3, .heading_rad = 0.05, .speed_mps = 0.3};
  std::mt19937_64 random(3);
  double squared_m2 = 0.0, believed_m2 = 0.0;
  int count = 0;
  Body body;
  MotionFilter filter(body.measured(noise, random), noise);
  for (int k = 0; k < 2000; ++k) {
    body.go_on(kStep_s, 0.2, 0.02, random);
    filter.predict(body.t_s);
    filter.update(body.measured(noise, random));
    if (k < 20) continue;
    const SeenMotion seen = filter.state();
    squared_m2 += std::pow(seen.pose.x_m - body.x_m, 2) + std::pow(seen.pose.y_m - body.y_m, 2);
    believed_m2 += 2.0 * std::pow(filter.position_deviation_m(), 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squared_m2 / count), 0.6 * 0.3 * std::sqrt(2.0));
  EXPECT_LT(squared_m2, believed_m2);  // it moves more quietly than the filter is ready for
}

/// Every 0.1 s of somebody at a speed, from a time on an acceleration, how fast it is believed to
/// be.
std::vector<double> believed_mps(const ObjectNoise& noise, double speed_mps, double speeds_up_mps2,
                                 unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::optional<MotionFilter> filter;
  std::vector<double> believed;
  double x_m = 5.0;
  for (int k = 0; k <= 300; ++k) {
    const double t_s = kStep_s * k;
    const MeasuredMotion measured{
        t_s,
        {x_m + noise.position_m * normal(random), 5.0 + noise.position_m * normal(random),
         noise.heading_rad * normal(random)},
        speed_mps + noise.speed_mps * normal(random)};
    if (filter) {
      filter->predict(t_s);
      filter->update(measured);
    } else {
      filter.emplace(measured, noise);
    }
    believed.push_back(filter->state().speed_mps);
    x_m += kStep_s * speed_mps;
    if (t_s >= 20.0) speed_mps += kStep_s * speeds_up_mps2;
  }
  return believed;
}

TEST(MotionFilter, WhoStandsDoesSoInAllNoiseUntilItSetsOff) {
  for (const double times : {0.1, 1.0, 2.0}) {
    const ObjectNoise noise{0.1 * times, 0.02 * times, 0.2 * times};
    for (unsigned seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(testing::Message() << times << " times the noise, seed " << seed);
      const std::vector<double> parked = believed_mps(noise, 0.0, 0.0, seed);
      // At first 3 deviations are passed by 1 of 370, until it is less than one.
      const auto drives = [](double mps) { return mps != 0.0; };
      EXPECT_TRUE(std::none_of(parked.begin() + 10, parked.end(), drives));
      const std::vector<double> leaves = believed_mps(noise, 0.0, 1.0, seed);
      EXPECT_GT(leaves[215], 0.7) << "1.5 s after it began to move";
    }
  }
}

TEST(MotionFilter, WhoWalksDoesNotStand) {
  const ObjectNoise noise{.position_m = 0.1, .heading_rad = 0.02, .speed_mps = 0.2};
  const std::vector<double> walks = believed_mps(noise, 1.0, 0.0, 3);
  EXPECT_GT(*std::min_element(walks.begin() + 20, walks.end()), 0.0);
}

}  // namespace
}  // namespace roadbed::planning
