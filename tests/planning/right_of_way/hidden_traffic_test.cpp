// Where somebody may come from at the stop sign of country.xodr, behind a hedge at the corner.
#include "roadbed/planning/right_of_way/hidden_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::planning {
namespace {

class HiddenTraffics : public testing::Test {
 protected:
  /// With the rear axle on the approach, at a y of the map, and the hedge there or not.
  HiddenTraffic::MayCome towards(double y_m, bool has_hedge) {
    const geometry::Rectangle vehicle =
        geometry::body_at({921.75, y_m, 0.5 * M_PI}, geometry::VehicleShape{});
    std::vector<geometry::Rectangle> others;
    if (has_hedge) {
      others.push_back({.centre = {914.5, -24.0}, .half_length_m = 0.5, .half_width_m = 15.0});
    }
    sight_.emplace(vehicle, 1000.0, std::move(others), nullptr, world_.road_map);
    return hidden_.towards(0, *sight_, 7.0);
  }

  tools::World world_ = tools::make_world(
      tools::read_scenario(tests::data_folder() / "scenarios" / "blind_corner.json"));
  HiddenTraffic hidden_{world_};
  std::optional<Visibility> sight_;
};

TEST_F(HiddenTraffics, NobodyIsExpectedWhereAllIsSeen) {
  ASSERT_EQ(world_.stop_points.size(), 1U);
  EXPECT_TRUE(towards(-25.0, false).cars.empty());
}

TEST_F(HiddenTraffics, MayBeWhereverTheyAreHiddenAndComeAtTheSpeedLimit) {
  const HiddenTraffic::MayCome hidden = towards(-25.0, true);
  ASSERT_FALSE(hidden.cars.empty());
  for (const Obstacle& other : hidden.cars) {
    const geometry::TrajectoryPoint now = other.motion.at(7.0);
    EXPECT_NEAR(now.y_m, -1.75, 1e-6) << "eastwards, from the left";
    EXPECT_NEAR(now.speed_mps, 80.0 / 3.6, 1e-9);
    EXPECT_NEAR(other.motion.at(9.0).x_m - now.x_m, 2.0 * 80.0 / 3.6, 0.01);
    for (const double ahead_m : {-1.2, 0.0, 1.2}) {
      EXPECT_FALSE(sight_->sees({now.x_m + ahead_m, -1.75})) << now.x_m << ", " << ahead_m;
    }
  }
  // Any 7.5 m of the lane within 100 m of which nothing is seen hold one.
  for (double x_m = 820.0; x_m < 895.0; x_m += 1.0) {
    bool is_hidden = true, holds_one = false;
    for (double at_m = 0.0; at_m <= 7.5; at_m += 0.5) {
      is_hidden = is_hidden && !sight_->sees({x_m + at_m, -1.75});
    }
    for (const Obstacle& other : hidden.cars) {
      const double away_m = other.motion.at(7.0).x_m - x_m;
      holds_one = holds_one || (away_m > -2.5 && away_m < 10.0);
    }
    EXPECT_TRUE(!is_hidden || holds_one) << x_m;
  }
}

TEST_F(HiddenTraffics, AreFewerWhereMoreIsSeen) {
  const std::size_t at_line = towards(-25.0, true).cars.size();
  EXPECT_GE(at_line, 32U) << "nearly all of 200 m";
  EXPECT_LT(towards(-14.0, true).cars.size(), at_line);
  // With its mirrors before the end of the hedge the lane is seen all along.
  EXPECT_TRUE(towards(-10.5, true).cars.empty());
}

TEST_F(HiddenTraffics, AreInTheWayFromTheEdgeOfTheirLaneOn) {
  const HiddenTraffic::MayCome hidden = towards(-25.0, true);
  ASSERT_EQ(hidden.in_the_way_from_m.size(), hidden.cars.size());
  for (const double s_m : hidden.in_the_way_from_m) {
    // A corner of the lane that turns, 1.75 m beside its middle, is at the edge of the other lane.
    const ReferencePoint at = world_.line.at(s_m);
    EXPECT_NEAR(at.in_map.y() - 1.75 * std::cos(at.heading_rad), -3.5, 0.05);
  }
}

}  // namespace
}  // namespace roadbed::planning
