// Corners of map lanes that no vehicle follows as they are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/line_driving.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;

constexpr double kLeg_m = 40.0, kFirst_mps = 10.0, kSecond_mps = 15.0;

// Eastwards to the origin, then northwards: borders of two points each, as in a hand-drawn
// Lanelet2 or CommonRoad map. Lanes may come the other way, beyond a marking that may be
// crossed.
struct Corner {
  double half_m;
  bool to_the_right = false, with_oncoming = false;
};

map::RoadMap polyline_corner(const Corner& corner) {
  const double side = corner.to_the_right ? -1.0 : 1.0, left_m = side * corner.half_m;
  using Border = std::vector<Vector2d>;
  const auto before = [&](double d_m) {  // a border d_m to the inside of the corner
    return Border{{-kLeg_m, side * d_m}, {-d_m, side * d_m}};
  };
  const auto behind = [&](double d_m) { return Border{{-d_m, side * d_m}, {-d_m, side * kLeg_m}}; };
  tests::MadeMap made;
  const map::RoadId road = made.add_road("1");
  const map::LaneId first = made.add_lane(road, "-1", before(left_m), before(-left_m));
  const map::LaneId second = made.add_lane(road, "-2", behind(left_m), behind(-left_m));
  made.link(first, second);
  made.lane(first).speed_limits = {{0.0, kFirst_mps}};
  made.lane(second).speed_limits = {{0.0, kSecond_mps}};
  const auto add_opposite = [&](map::LaneId lane, const char* name, Border left, Border right) {
    std::ranges::reverse(left);
    std::ranges::reverse(right);
    made.put_opposite(lane, made.add_lane(road, name, left, right));
    made.parts.links.at(lane.index).left->change_windows = {{0.0, 1e3}};
  };
  if (corner.with_oncoming) {
    add_opposite(first, "1", before(left_m), before(3.0 * left_m));
    add_opposite(second, "2", behind(left_m), behind(3.0 * left_m));
  }
  return made.build();
}

bool in_lane(const Vector2d& place, const Corner& corner, double margin_m) {
  const double w_m = corner.half_m + margin_m;
  const double y_m = corner.to_the_right ? -place.y() : place.y();
  const bool on_first = std::abs(y_m) < w_m && place.x() < w_m;
  return on_first || (std::abs(place.x()) < w_m && y_m > -w_m);
}

ReferenceLine line_for(const map::RoadMap& road_map,
                       const std::optional<geometry::VehicleShape>& vehicle) {
  const map::LaneId last{road_map.lanes().size() > 1 ? 1u : 0u};
  const double end_m = road_map.lane(last).length_m() - 5.0;
  const RouteAnswer answer = find_route(road_map, {{0}, 5.0, 0.0}, {last, end_m, 0.0});
  EXPECT_TRUE(answer.route) << answer.reason;
  return ReferenceLine::along(road_map, answer.route.value(), {.corner_vehicle = vehicle});
}

// Of positions alone: turns of chords. Truncation is of the order of h² κ″.
struct Measured {
  double peak_per_m = 0.0, peak_rate_per_m2 = 0.0, rate_jump_per_m2 = 0.0, slowest_mps = 1e9;
};

Measured measure(const ReferenceLine& line, const geometry::VehicleShape& vehicle) {
  constexpr double kH = 0.02;
  const auto heading = [&](double s_m) {
    const Vector2d chord = line.at(s_m + 0.5 * kH).in_map - line.at(s_m - 0.5 * kH).in_map;
    return std::atan2(chord.y(), chord.x());
  };
  const auto curvature = [&](double s_m) {
    return (heading(s_m + 0.5 * kH) - heading(s_m - 0.5 * kH)) / kH;
  };
  Measured most;
  double before = 0.0;
  for (double s_m = 1.0; s_m < line.goal_s_m() - 1.0; s_m += kH) {
    const double k = curvature(s_m), rate = (curvature(s_m + kH) - curvature(s_m - kH)) / (2 * kH);
    most.peak_per_m = std::max(most.peak_per_m, std::abs(k));
    most.peak_rate_per_m2 = std::max(most.peak_rate_per_m2, std::abs(rate));
    if (s_m > 1.0) most.rate_jump_per_m2 = std::max(most.rate_jump_per_m2, std::abs(rate - before));
    const double tangent = vehicle.wheelbase_m * k;
    const double steering_per_m = vehicle.wheelbase_m * std::abs(rate) / (1.0 + tangent * tangent);
    most.slowest_mps =
        std::min(most.slowest_mps, vehicle.max_steering_rate_radps / (steering_per_m + 1e-9));
    before = rate;
  }
  return most;
}

double body_outside_m(const ReferenceLine& line, const Corner& corner) {
  const geometry::VehicleShape vehicle;
  double outside_m = -0.5;
  for (double s_m = 0.0; s_m < line.goal_s_m(); s_m += 0.05) {
    const ReferencePoint at = line.at(s_m);
    const geometry::Pose2 pose{at.in_map.x(), at.in_map.y(), at.heading_rad};
    for (const Vector2d& place : body_outline(vehicle)) {
      while (!in_lane(pose * place, corner, outside_m)) outside_m += 0.005;
    }
  }
  return outside_m;
}

double distance_of_corner_m(const ReferenceLine& line) {
  double least_m = 1e9;
  for (double s_m = 0.0; s_m < line.goal_s_m(); s_m += 0.01) {
    least_m = std::min(least_m, line.at(s_m).in_map.norm());
  }
  return least_m;
}

class RoundedCorner : public testing::TestWithParam<Corner> {};

TEST_P(RoundedCorner, OfPolylinesIsSteeredWithinTheLane) {
  const geometry::VehicleShape vehicle;
  const map::RoadMap road_map = polyline_corner(GetParam());
  const ReferenceLine plain = line_for(road_map, {}), line = line_for(road_map, vehicle);
  EXPECT_GT(measure(plain, vehicle).peak_per_m, 0.8);
  EXPECT_LT(measure(plain, vehicle).slowest_mps, 0.7);
  EXPECT_GT(body_outside_m(plain, GetParam()), 0.6);
  const Measured rounded = measure(line, vehicle);
  EXPECT_LT(rounded.peak_per_m, 0.33);
  EXPECT_GT(rounded.slowest_mps, 1.9);
  // A Bézier curve alone would join the legs with a jump of κ′.
  EXPECT_LT(rounded.rate_jump_per_m2, 0.03 * rounded.peak_rate_per_m2);
  EXPECT_LT(body_outside_m(line, GetParam()), 0.05);
  EXPECT_TRUE(line.notes().empty()) << line.notes().front();
  EXPECT_NEAR(line.largest_move_m(), distance_of_corner_m(line), 0.01);
}

TEST_P(RoundedCorner, HasTheCorridorOfTheLaneBesideIt) {
  const map::RoadMap road_map = polyline_corner(GetParam());
  const ReferenceLine line = line_for(road_map, geometry::VehicleShape{});
  for (double s_m = 0.0; s_m < line.goal_s_m(); s_m += 1.0) {
    const Vector2d at = line.at(s_m).in_map;
    const double past_corner_m = std::abs(at.y()) + at.x();  // the diagonal parts the lanes
    if (std::abs(past_corner_m) < 1.0) continue;
    const Corridor room = line.corridor_at(s_m);
    EXPECT_EQ(room.speed_limit_mps, past_corner_m < 0.0 ? kFirst_mps : kSecond_mps) << s_m;
    if (at.norm() < 10.0) continue;  // the line runs as the lane does: from border to border
    const double lanes = GetParam().with_oncoming ? 4.0 : 2.0;
    EXPECT_NEAR(room.right_m + room.left_m, lanes * GetParam().half_m, 0.02) << s_m;
  }
}

INSTANTIATE_TEST_SUITE_P(Made, RoundedCorner,
                         testing::Values(Corner{1.75}, Corner{1.75, true}, Corner{2.0},
                                         Corner{2.0, true, true}, Corner{2.5, false, true}));

// An arc of 1 m between two straight lines, the lane's middle on it.
TEST(RoundedCorners, OfAnOpenDriveRoadIsSteered) {
  tests::MadeRoad road;
  road.id = "1";
  road.length_m = 81.0;
  road.lanes = R"(<laneOffset s="0" a="2.25" b="0" c="0" d="0"/>)" +
               tests::made_section(0.0, "", tests::made_lane(-1, "", "driving", 4.5));
  road.plan_view = R"(<geometry s="0" x="0" y="0" hdg="0" length="40"><line/></geometry>
    <geometry s="40" x="40" y="0" hdg="0" length="1.5707963267948966">
      <arc curvature="1"/></geometry>
    <geometry s="41.5707963267948966" x="41" y="1" hdg="1.5707963267948966"
      length="39.4292036732051034"><line/></geometry>)";
  const map::RoadMap road_map = tests::made_map(tests::made_road(road));
  const geometry::VehicleShape vehicle;
  const ReferenceLine plain = line_for(road_map, {}), line = line_for(road_map, vehicle);
  EXPECT_LT(measure(plain, vehicle).slowest_mps, kWalkingSpeed_mps);
  const Measured rounded = measure(line, vehicle);
  EXPECT_LT(rounded.peak_per_m, drivable_curvature_per_m(vehicle));
  EXPECT_GT(rounded.slowest_mps, kWalkingSpeed_mps);
  EXPECT_LT(rounded.rate_jump_per_m2, 0.03 * rounded.peak_rate_per_m2);
  EXPECT_TRUE(line.notes().empty()) << line.notes().front();
}

// The sides of an octagon, 8 m each: bends that the vehicle steers.
TEST(RoundedCorners, LeaveALineAsItIsThatCanBeDriven) {
  tests::MadeMap made;
  std::vector<Vector2d> left, right;
  for (int i = 0; i <= 6; ++i) {
    const double turned = i * std::numbers::pi / 4.0;
    const Vector2d outwards(std::cos(turned), std::sin(turned));
    left.push_back(9.0 * outwards);
    right.push_back(13.0 * outwards);
  }
  made.add_lane(made.add_road("1"), "-1", left, right);
  const map::RoadMap road_map = made.build();
  const ReferenceLine plain = line_for(road_map, {}), line = line_for(road_map, {{}});
  ASSERT_EQ(plain.length_m(), line.length_m());
  for (double s_m = -5.0; s_m < line.length_m(); s_m += 0.1) {
    EXPECT_EQ(plain.at(s_m).in_map, line.at(s_m).in_map);
    EXPECT_EQ(plain.corridor_at(s_m).left_m, line.corridor_at(s_m).left_m);
  }
}

TEST(RoundedCorners, AreLeftAndSaidWhereThereIsNoRoomForTheBody) {
  const map::RoadMap road_map = polyline_corner({1.0});
  const ReferenceLine line = line_for(road_map, geometry::VehicleShape{});
  ASSERT_GE(line.notes().size(), 2u);
  EXPECT_NE(line.notes()[0].find("is not rounded: none of "), std::string::npos);
  EXPECT_NE(line.notes()[1].find("bends up to 0.8"), std::string::npos) << line.notes()[1];
}

}  // namespace
}  // namespace roadbed::planning
