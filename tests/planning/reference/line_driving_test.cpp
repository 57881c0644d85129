#include "roadbed/planning/reference/line_driving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/analytic_line.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;

constexpr double kStraight_m = 40.0, kBend_m = 3.8;

// One lane eastwards, a quarter circle to the left whose middle has a radius of 3.8 m, northwards.
map::RoadMap sharp_bend(double half_width_m) {
  std::vector<Vector2d> left, right;
  const auto add = [&](const Vector2d& middle, double heading_rad) {
    const Vector2d normal(-std::sin(heading_rad), std::cos(heading_rad));
    left.push_back(middle + half_width_m * normal);
    right.push_back(middle - half_width_m * normal);
  };
  for (int i = 0; i < 40; ++i) add({-kStraight_m + i * kStraight_m / 40.0, 0.0}, 0.0);
  for (int i = 0; i <= 20; ++i) {
    const double turned = 0.5 * std::numbers::pi * i / 20.0;
    add({kBend_m * std::sin(turned), kBend_m - kBend_m * std::cos(turned)}, turned);
  }
  for (int i = 1; i <= 40; ++i) {
    add({kBend_m, kBend_m + i * kStraight_m / 40.0}, 0.5 * std::numbers::pi);
  }
  tests::MadeMap made;
  made.add_lane(made.add_road("1"), "-1", left, right);
  return made.build();
}

geometry::VehicleShape car() {
  geometry::VehicleShape vehicle;
  vehicle.max_steering_rad = std::atan(0.2 * vehicle.wheelbase_m);  // a radius of 5 m
  return vehicle;
}

ReferenceLine line_on(const map::RoadMap& road_map, const ReferenceLineOptions& options) {
  const RouteAnswer answer = find_route(road_map, {{0}, 5.0, 0.0}, {{0}, 80.0, 0.0});
  EXPECT_TRUE(answer.route) << answer.reason;
  return ReferenceLine::along(road_map, answer.route.value(), options);
}

double peak_per_m(const ReferenceLine& line) {
  double peak = 0.0;
  for (double s_m = 0.0; s_m < line.goal_s_m(); s_m += 0.05) {
    peak = std::max(peak, std::abs(line.at(s_m).curvature_per_m));
  }
  return peak;
}

TEST(ReferenceLineAlong, IsDrawnAnewInABendThatTheVehicleCannotSteer) {
  const map::RoadMap wide = sharp_bend(2.5);
  const ReferenceLine plain = line_on(wide, {}), line = line_on(wide, {.corner_vehicle = car()});
  EXPECT_GT(peak_per_m(plain), 0.21);
  EXPECT_LE(peak_per_m(line), 0.1805);  // a tenth of what it steers is left
  EXPECT_TRUE(line.notes().empty()) << line.notes().front();
  EXPECT_GT(line.largest_move_m(), 0.3);
  EXPECT_LE(line.largest_move_m(), 1.5);
  for (double s_m = 0.0; s_m < line.goal_s_m(); s_m += 0.1) {
    const ReferencePoint at = line.at(s_m);
    const geometry::Pose2 pose{at.in_map.x(), at.in_map.y(), at.heading_rad};
    for (const Vector2d& corner : car().corners_in_vehicle()) {
      EXPECT_TRUE(wide.on_surface(pose * corner, 0.06)) << s_m;
    }
    // Elsewhere it keeps to the middle as before.
    const bool is_before = at.in_map.x() < -14.0;
    EXPECT_LT(is_before ? std::abs(at.in_map.y()) : 0.0, 0.31);
  }
}

TEST(ReferenceLineAlong, SaysWhereTheVehicleCannotFollowIt) {
  const ReferenceLine line = line_on(sharp_bend(1.0), {.corner_vehicle = car()});
  ASSERT_FALSE(line.notes().empty());
  const bool bends = std::ranges::any_of(line.notes(), [](const std::string& note) {
    return note.find("of the 0.200 1/m that the vehicle steers") != std::string::npos;
  });
  EXPECT_TRUE(bends) << line.notes().front();
  EXPECT_TRUE(line_on(sharp_bend(1.0), {}).notes().empty());  // nobody in particular drives
}

TEST(LineDriving, FindsPeaksAndTheSpeedThatTheSteeringAllows) {
  // A clothoid: κ = 0.005 s, so κ′ is 0.005 all along and κ greatest at its end.
  const tests::AnalyticLine clothoid{.curvature = {0.0, 0.005, 0.0, 0.0, 0.0}};
  const geometry::VehicleShape vehicle = car();
  const LineDriving driving = driving_along(clothoid.view(), 50.0, vehicle, {});
  EXPECT_NEAR(driving.peak_curvature_per_m.value, 0.25, 1e-12);
  EXPECT_EQ(driving.peak_curvature_per_m.s_m, 50.0);
  EXPECT_NEAR(driving.peak_curvature_rate_per_m2.value, 0.005, 1e-12);
  // δ = atan(L κ): straight ahead it turns fastest, by L κ′ per metre.
  EXPECT_NEAR(driving.slowest_mps.value, 0.4 / (vehicle.wheelbase_m * 0.005), 1e-9);
  EXPECT_EQ(driving.slowest_mps.s_m, 0.0);
  ASSERT_EQ(driving.bends.size(), 1u);
  EXPECT_NEAR(driving.bends[0].from_s_m, 36.25, 1e-9);  // 0.9 of the 0.2 1/m
  EXPECT_EQ(driving.bends[0].to_s_m, 50.0);
  EXPECT_NEAR(length_of(driving.bends), 14.0, 1e-9);
}

TEST(LineDriving, NamesBendsThatAskForTooMuchSteeringRateAtWalkingSpeed) {
  // δ = atan(L κ) changes by 0.4 rad/s at 1.4 m/s where L κ′ = 0.4 / 1.4, if κ is small.
  const geometry::VehicleShape vehicle = car();
  const double greatest = 0.4 / (1.4 * vehicle.wheelbase_m);
  for (const double part : {0.99, 1.01}) {
    const tests::AnalyticLine kink{.curvature = {0.0, part * greatest, 0.0, 0.0, 0.0}};
    const LineDriving driving = driving_along(kink.view(), 0.2, vehicle, {});
    ASSERT_EQ(driving.bends.size(), part > 1.0 ? 1u : 0u);
    for (const LineFault& bend : driving.bends) {
      EXPECT_EQ(bend.reason, "can be steered at 1.39 m/s at most");
    }
  }
}

TEST(LineDriving, NamesTheStretchOnWhichTheBodyLeavesTheRoad) {
  const tests::AnalyticLine straight;
  const geometry::VehicleShape vehicle = car();
  // A hole from x = 20 m to 22 m, left of the middle.
  const auto on_road = [](const Vector2d& place) {
    return !(place.x() > 20.0 && place.x() < 22.0 && place.y() > 0.5);
  };
  const LineDriving driving = driving_along(straight.view(), 40.0, vehicle, on_road);
  ASSERT_EQ(driving.leaves.size(), 1u);
  EXPECT_NEAR(driving.leaves[0].from_s_m, 20.0 - vehicle.front_m(), 0.26);
  EXPECT_NEAR(driving.leaves[0].to_s_m, 22.0 + vehicle.rear_overhang_m, 0.26);
  EXPECT_TRUE(driving.bends.empty());
}

}  // namespace
}  // namespace roadbed::planning
