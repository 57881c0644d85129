#include "roadbed/planning/speed/safe_stop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/control/lower_controller.h"
#include "roadbed/tests/support/straight_profile.h"
#include "roadbed/tests/support/straight_world.h"

namespace roadbed::planning {
namespace {

constexpr double kBraking_mps2 = 8.0, kCycle_s = 0.1, kFront_m = 0.5 * 4.5;

class SafeStop : public testing::Test {
 protected:
  static Obstacle driving(double x_m, double speed_mps) {
    const auto at = [&](double t_s) {
      return geometry::TrajectoryPoint{
          .t_s = t_s, .x_m = x_m + speed_mps * t_s, .speed_mps = speed_mps};
    };
    return {.id = "other", .motion = geometry::Trajectory({at(0.0), at(10.0)})};
  }

  MayBeMet may_be(const Obstacle& other) const {
    return {0, ReachableSet(world_.road_map, other, 0.0, 8.0, by_the_rules())};
  }

  PathProfile profile_ = tests::straight_profile(20.0);
  tools::World world_ = tests::straight_world({.from_x_m = -50.0, .to_x_m = 400.0}, {});
};

/// Least gap while the vehicle holds a command for a cycle and then brakes, behind the lag of its
/// actuator, and who is ahead drives as `other_mps2` says, until the vehicle stands.
template <typename Other>
double least_gap_m(double gap_m, double speed_mps, double command_mps2, double other_mps,
                   const Other& other_mps2) {
  constexpr double kStep_s = 1e-3;
  double least_m = gap_m, acceleration_mps2 = 0.0;
  for (double t_s = 0.0; speed_mps > 0.0 || t_s < kCycle_s; t_s += kStep_s) {
    const double wanted_mps2 = t_s < kCycle_s ? command_mps2 : -kBraking_mps2;
    acceleration_mps2 = control::actuate(acceleration_mps2, wanted_mps2, kStep_s);
    speed_mps = std::max(0.0, speed_mps + acceleration_mps2 * kStep_s);
    other_mps = std::max(0.0, other_mps + other_mps2(t_s) * kStep_s);
    gap_m += (other_mps - speed_mps) * kStep_s;
    least_m = std::min(least_m, gap_m);
  }
  return least_m;
}

TEST_F(SafeStop, IsFreeWhereItEndsBehindALeadThatBrakesAsHardAtOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> gap_m(1.0, 60.0), own_mps(0.5, 25.0), other_mps(0.0, 20.0),
      command(-8.0, 2.0);
  const auto brakes = [](double) { return -kBraking_mps2; };
  int free = 0, barred = 0;
  for (int i = 0; i < 1000; ++i) {
    const double gap = gap_m(random), own = own_mps(random), other = other_mps(random),
                 held = command(random);
    const double x_m =
        profile_.body.front().centre.x() + profile_.body.front().half_length_m + gap + kFront_m;
    const std::vector<MayBeMet> others{may_be(driving(x_m, other))};
    const double least_m = least_gap_m(gap, own, held, other, brakes);
    // Up to a sample of the path and the way of 0.1 s too soon.
    if (least_m > -0.1 && least_m < 0.7 + 0.1 * own) continue;
    const bool is_barred =
        who_may_bar_stop({.profile = profile_, .speed_mps = own, .others = others}, held)
            .has_value();
    EXPECT_EQ(is_barred, least_m < 0.0)
        << gap << " m, " << own << " and " << other << " m/s, " << held << ": " << least_m;
    (is_barred ? barred : free)++;
  }
  EXPECT_GT(free, 100);
  EXPECT_GT(barred, 100);
}

TEST_F(SafeStop, AfterASafeCommandNoLeadIsTouchedWhateverItDoes) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> gap_m(1.0, 50.0), own_mps(1.0, 25.0), other_mps(0.0, 20.0),
      any_mps2(-kBraking_mps2, by_the_rules().max_gain_mps2);
  int eased = 0, asked = 0;
  for (int i = 0; i < 1000; ++i) {
    const double gap = gap_m(random), own = own_mps(random), other = other_mps(random);
    const double x_m =
        profile_.body.front().centre.x() + profile_.body.front().half_length_m + gap + kFront_m;
    const std::vector<MayBeMet> others{may_be(driving(x_m, other))};
    const SafeCommand safe =
        safe_command({.profile = profile_, .speed_mps = own, .others = others}, 1.5);
    if (!safe.is_safe) continue;
    EXPECT_EQ(safe.command_mps2 < 1.5, safe.who.has_value());
    eased += safe.who.has_value();
    ++asked;
    for (int behaviour = 0; behaviour < 20; ++behaviour) {
      double mps2 = -kBraking_mps2, until_s = 0.5;
      const auto anyhow = [&](double t_s) {
        if (behaviour > 0 && t_s >= until_s) {
          mps2 = any_mps2(random);
          until_s += 0.5;
        }
        return mps2;
      };
      EXPECT_GT(least_gap_m(gap, own, safe.command_mps2, other, anyhow), 0.0);
    }
  }
  EXPECT_GT(asked, 150);
  EXPECT_GT(eased, 5);
}

TEST_F(SafeStop, WhoKeepsToTheLaneBesideBarsNothing) {
  Obstacle beside = driving(20.0, 5.0);
  const std::vector<MayBeMet> there{may_be(beside)};
  PathProfile aside = profile_;  // a lane's width to the left
  for (geometry::Rectangle& body : aside.body) body.centre.y() += 4.0;
  EXPECT_FALSE(who_may_bar_stop({.profile = aside, .speed_mps = 20.0, .others = there}, 0.0));
  EXPECT_TRUE(who_may_bar_stop({.profile = profile_, .speed_mps = 20.0, .others = there}, 0.0));
}

TEST_F(SafeStop, NothingIsSafeBeforeAWallThatIsTooNear) {
  Obstacle wall{.id = "wall", .motion = geometry::Trajectory({{.t_s = 0.0, .x_m = 14.0}})};
  const std::vector<MayBeMet> there{may_be(wall)};
  const SafeCommand safe =
      safe_command({.profile = profile_, .speed_mps = 20.0, .others = there}, 1.0);
  EXPECT_FALSE(safe.is_safe);
  EXPECT_EQ(safe.command_mps2, 0.0);
}

}  // namespace
}  // namespace roadbed::planning
