// Driving on and on with the planner, ten cycles a second: overtaking as in Fig. 8 of the paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/lateral/maneuver_completion.h"
#include "roadbed/planning/plan.h"

namespace roadbed::planning {
namespace {

using geometry::Rectangle;
using geometry::VehicleShape;

constexpr double kCycle_s = 0.1;

// The own lane, 3.5 m wide, and one to its left, in a wide bend.
class TwoLaneBend {
 public:
  ReferencePoint at(double s_m) const { return line_.at(s_m); }
  LineView view() const {
    return {[line = line_](double s_m) { return line.at(s_m); },
            [](double) { return Corridor{.left_m = 5.25, .right_m = 1.75}; }};
  }

 private:
  static std::vector<Eigen::Vector2d> bend() {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= 20; ++i) {
      const double angle = 0.03 * i;
      points.push_back({500.0 * std::sin(angle), 500.0 - 500.0 * std::cos(angle)});
    }
    return points;
  }
  ReferenceLine line_ = ReferenceLine::through(bend(), 3.5, 15.0);
};

// Drives along a line at a constant offset, with or against its direction.
struct Car {
  double from_s_m, d_m, speed_mps;

  double s_m(double t_s) const { return from_s_m + speed_mps * t_s; }
};

geometry::Pose2 centre_of(const Car& car, const TwoLaneBend& line, double t_s) {
  const ReferencePoint at = line.at(car.s_m(t_s));
  return {at.in_map.x() - car.d_m * std::sin(at.heading_rad),
          at.in_map.y() + car.d_m * std::cos(at.heading_rad),
          at.heading_rad + (car.speed_mps < 0.0 ? std::numbers::pi : 0.0)};
}

PredictedObstacle seen_at(const Car& car, const TwoLaneBend& line, double t_s) {
  const ObservedMotion seen{
      .t_s = t_s, .pose = centre_of(car, line, t_s), .speed_mps = std::abs(car.speed_mps)};
  return {.id = "car",
          .motion = Prediction::along_line(line.view(), {car.s_m(t_s), car.d_m}, seen, 12.0)};
}

// What the drive was like.
struct Drive {
  double least_distance_m = 1e300;
  double most_d_m = 0.0;
  double end_s_m = 0.0, end_d_m = 0.0;
  double out_from_s_m = 1e300;  // where it first was half a lane out
  int stops = 0;                // cycles without a plan
};

// The vehicle follows each plan exactly; it brakes where there is none, else gathers speed again.
Drive drive(const TwoLaneBend& line, const std::vector<Car>& cars, double duration_s) {
  constexpr double kSpeed_mps = 12.0, kSpeedUp_mps2 = 1.0, kBraking_mps2 = 6.0;
  const std::vector<Obstacle> none;
  Drive result;
  LateralState state{.s_m = 5.0};
  double speed_mps = kSpeed_mps;
  LateralPath path;
  for (double t_s = 0.0; t_s < duration_s; t_s += kCycle_s) {
    std::vector<PredictedObstacle> predicted;
    for (const Car& car : cars) predicted.push_back(seen_at(car, line, t_s));
    PlanInput input{.line = line.view(),
                    .start = state,
                    .start_t_s = t_s,
                    .speed = {speed_mps, speed_mps < kSpeed_mps ? kSpeedUp_mps2 : 0.0, kSpeed_mps},
                    .obstacles = none,
                    .predicted = predicted};
    if (path) input.previous_d_m = [path](double s_m) { return path(s_m).d_m; };
    const Plan plan = plan_path(input, VehicleShape{}, {.d_step_m = 0.25, .l_step_m = 1.0});
    if (plan.chosen) {
      path = [plan](double s_m) { return plan.lateral_at(s_m); };
      speed_mps = std::min(kSpeed_mps, speed_mps + kSpeedUp_mps2 * kCycle_s);
    } else {
      ++result.stops;
      speed_mps = std::max(0.0, speed_mps - kBraking_mps2 * kCycle_s);
      if (!path) path = [state](double s_m) { return LateralState{.s_m = s_m, .d_m = state.d_m}; };
    }
    const double along = 1.0 - line.at(state.s_m).curvature_per_m * state.d_m;
    const double s_m = state.s_m + speed_mps * kCycle_s / std::hypot(along, state.d_slope);
    state = path(s_m);
    state.s_m = s_m;
    const ReferencePoint at = line.at(s_m);
    const geometry::Pose2 pose{
        at.in_map.x() - state.d_m * std::sin(at.heading_rad),
        at.in_map.y() + state.d_m * std::cos(at.heading_rad),
        at.heading_rad + std::atan2(state.d_slope, 1.0 - at.curvature_per_m * state.d_m)};
    const Rectangle body = geometry::body_at(pose, VehicleShape{});
    for (const Car& car : cars) {
      const Rectangle other = body_around(centre_of(car, line, t_s + kCycle_s), 4.5, 1.8);
      result.least_distance_m =
          std::min(result.least_distance_m, geometry::distance_m(body, other));
    }
    result.most_d_m = std::max(result.most_d_m, state.d_m);
    if (state.d_m > 1.75) result.out_from_s_m = std::min(result.out_from_s_m, s_m);
  }
  result.end_s_m = state.s_m;
  result.end_d_m = state.d_m;
  return result;
}

TEST(Overtaking, PassesASlowerCarAndComesBackToItsLane) {
  const Car slower{45.0, 0.0, 4.0};
  const Drive result = drive(TwoLaneBend{}, {slower}, 15.0);
  EXPECT_GT(result.least_distance_m, 0.25);
  EXPECT_GT(result.most_d_m, 1.9);
  EXPECT_GT(result.end_s_m, slower.s_m(15.0) + 20.0);
  EXPECT_NEAR(result.end_d_m, 0.0, 0.2);
  EXPECT_EQ(result.stops, 0);
}

TEST(Overtaking, WaitsForOncomingTrafficAndThenPasses) {
  const Car slower{45.0, 0.0, 4.0}, oncoming{130.0, 3.5, -9.0};
  const Drive free = drive(TwoLaneBend{}, {slower}, 26.0);
  const Drive result = drive(TwoLaneBend{}, {slower, oncoming}, 26.0);
  EXPECT_GT(result.least_distance_m, 0.05);
  EXPECT_GT(result.stops, 0);
  EXPECT_GT(result.out_from_s_m, free.out_from_s_m + 3.0);
  EXPECT_GT(result.most_d_m, 1.9);
  EXPECT_GT(result.end_s_m, slower.s_m(26.0) + 10.0);
  EXPECT_NEAR(result.end_d_m, 0.0, 0.3);
}

}  // namespace
}  // namespace roadbed::planning
