// Who may step out from where nothing is seen.
#include "roadbed/planning/right_of_way/hidden_walkers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::planning {
namespace {

/// A straight path eastwards, the front's middle at (0, 0) at first.
class HiddenWalkersBeside : public testing::Test {
 protected:
  std::vector<HiddenWalker> find(double wanted_mps = 14.0) const {
    PathProfile path;
    for (double s_m = 0.0; s_m <= 40.0; s_m += 0.5) {
      path.ahead_m.push_back(s_m);
      path.station_m.push_back(s_m);
      path.body.push_back(geometry::body_at({s_m - vehicle_.front_m(), 0.0, 0.0}, vehicle_));
      path.wanted_mps.push_back(wanted_mps);
    }
    return find_hidden_walkers({.path = path,
                                .line = line_,
                                .vehicle = vehicle_,
                                .task = world_,
                                .traffic = Traffic{obstacles_},
                                .t_s = 0.0});
  }

  /// A car of 4.5 m by 1.8 m that stands beside the path.
  void park(double x_m, double beside_m) {
    const double y_m = -(0.5 * vehicle_.width_m + beside_m + 0.9);
    obstacles_.push_back(
        {.id = "parked", .motion = geometry::Trajectory({{.x_m = x_m, .y_m = y_m}})});
  }

  const geometry::VehicleShape vehicle_;
  ReferenceLine line_ = ReferenceLine::through({{0.0, 0.0}, {60.0, 0.0}}, 10.0, 50.0 / 3.6);
  const tools::World world_ = tools::make_world(
      tools::read_scenario(tests::data_folder() / "scenarios" / "parked_car.json"));
  std::vector<Obstacle> obstacles_;
};

TEST_F(HiddenWalkersBeside, AreNoneOnAnOpenRoad) { EXPECT_TRUE(find().empty()); }

TEST_F(HiddenWalkersBeside, AreBehindAParkedCarAsFarAsItHidesThem) {
  park(20.0, 1.0);
  const std::vector<HiddenWalker> walkers = find();
  ASSERT_FALSE(walkers.empty());
  // They step out behind its far end, at 22.25 m, or before its near one only where it is hidden.
  EXPECT_NEAR(walkers.front().ahead_m, 22.5, 0.5);
  EXPECT_NEAR(walkers.front().aside_m, 1.0, 0.25);
  for (const HiddenWalker& walker : walkers) EXPECT_GT(walker.ahead_m, 22.25);
  EXPECT_DOUBLE_EQ(walkers.front().most_mps, speed_past_walker_mps(walkers.front().aside_m));
}

TEST_F(HiddenWalkersBeside, AreInTheGapBetweenTwoParkedCars) {
  park(20.0, 1.5);
  park(26.0, 1.5);
  const std::vector<HiddenWalker> walkers = find();
  EXPECT_TRUE(std::ranges::any_of(walkers, [](const HiddenWalker& walker) {
    return walker.ahead_m > 22.3 && walker.ahead_m < 23.7;
  }));
  EXPECT_TRUE(std::ranges::none_of(walkers, [](const HiddenWalker& walker) {
    return walker.ahead_m < 22.25 || (walker.ahead_m > 24.0 && walker.ahead_m < 28.0);
  })) << "nobody walks through a car";
}

TEST_F(HiddenWalkersBeside, AreNotBehindWhoDrives) {
  park(20.0, 1.0);
  obstacles_[0].motion = geometry::Trajectory(
      {{.t_s = 0.0, .x_m = 20.0, .y_m = -2.7}, {.t_s = 9.0, .x_m = 21.0, .y_m = -2.7}});
  EXPECT_TRUE(find().empty());
}

TEST_F(HiddenWalkersBeside, AreNotBehindWhatStandsFarAside) {
  park(20.0, 4.5);
  EXPECT_TRUE(find().empty());
}

TEST_F(HiddenWalkersBeside, AreNotExpectedOnAMotorway) {
  park(20.0, 1.0);
  line_ = ReferenceLine::through({{0.0, 0.0}, {60.0, 0.0}}, 10.0, 100.0 / 3.6);
  EXPECT_TRUE(find().empty());
}

TEST_F(HiddenWalkersBeside, AreNoMatterForWhoIsSlow) {
  park(20.0, 1.0);
  EXPECT_TRUE(find(2.8).empty());
}

/// Walks at 1.4 m/s into the way of a vehicle that is told 0.5 s after he comes into sight, a gap
/// from its side, and brakes by 8 m/s². Whether its front hits him.
bool is_hit(double gap_m, double speed_mps, double ahead_m) {
  double front_m = 0.0;
  for (double t_s = 0.0; t_s < 10.0 && front_m < ahead_m; t_s += 0.001) {
    if (t_s > 0.5) speed_mps = std::max(0.0, speed_mps - 8.0 * 0.001);
    front_m += 0.001 * speed_mps;
    if (front_m >= ahead_m) return 1.4 * t_s > gap_m;
  }
  return false;
}

TEST(SpeedPastWalker, IsTheMostAtWhichNoFrontHitsAnybody) {
  for (double gap_m = 1.2; gap_m <= 4.0; gap_m += 0.1) {
    const double most_mps = speed_past_walker_mps(gap_m);
    if (most_mps <= 2.81) continue;
    bool is_hit_at_more = false;
    for (double ahead_m = 0.05; ahead_m < 60.0; ahead_m += 0.05) {
      EXPECT_FALSE(is_hit(gap_m, most_mps - 0.05, ahead_m)) << gap_m << ", " << ahead_m;
      is_hit_at_more = is_hit_at_more || is_hit(gap_m, most_mps + 1.0, ahead_m);
    }
    EXPECT_TRUE(is_hit_at_more) << gap_m;
  }
  EXPECT_DOUBLE_EQ(speed_past_walker_mps(0.3), 2.8) << "walking pace";
}

TEST(SpeedBeforeWalkers, BrakesToEachOfThemInTime) {
  const std::vector<HiddenWalker> walkers{{10.0, 1.5, 5.0}, {30.0, 1.0, 3.0}};
  EXPECT_NEAR(speed_before_walkers(walkers, 0.0, 1.5).speed_mps, std::sqrt(25.0 + 30.0), 1e-12);
  EXPECT_DOUBLE_EQ(speed_before_walkers(walkers, 0.0, 1.5).acceleration_mps2, -1.5);
  EXPECT_NEAR(speed_before_walkers(walkers, 10.0, 1.5).speed_mps, 5.0, 1e-12);
  EXPECT_NEAR(speed_before_walkers(walkers, 20.0, 1.5).speed_mps, std::sqrt(9.0 + 30.0), 1e-12);
  EXPECT_EQ(speed_before_walkers(walkers, 31.0, 1.5).speed_mps,
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace roadbed::planning
