#include "roadbed/planning/reference/way_point_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;
using geometry::CornerGaps;
using geometry::QuinticBezier;
using geometry::VehicleShape;

// Legs of one length with a turn to the left between them.
CornerQuestion corner(double leg_m, double turn_deg, double speed_mps) {
  const double turn_rad = turn_deg * std::numbers::pi / 180.0;
  return {.before = {-leg_m, 0.0},
          .at = {0.0, 0.0},
          .after = leg_m * Vector2d(std::cos(turn_rad), std::sin(turn_rad)),
          .speed_mps = speed_mps,
          .drivable = {}};
}

// Peak of |dκ/ds| by differences over a dense sampling.
double peak_rate_per_m2(const CornerQuestion& question, const CornerGaps& gaps) {
  const auto curve = QuinticBezier::corner(question.before, question.at, question.after, gaps);
  double peak = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i / 4000.0, h = 1.0 / 4000.0;
    const double way_m = (curve.at(t + h) - curve.at(t)).norm();
    peak =
        std::max(peak, std::abs(curve.curvature_per_m(t + h) - curve.curvature_per_m(t)) / way_m);
  }
  return peak;
}

TEST(CornerGaps, OfFourteenMetresAtARightAngleAreGentlerThanThePapers) {
  const CornerQuestion question = corner(14.0, 90.0, 8.0);
  const CornerChoice choice = choose_corner_gaps(question, VehicleShape{});
  ASSERT_TRUE(choice.gaps) << choice.reason;
  EXPECT_EQ(choice.gaps->first_m, choice.gaps->second_m);
  EXPECT_NEAR(choice.peak_rate_per_m2, peak_rate_per_m2(question, *choice.gaps), 1e-4);
  EXPECT_LE(choice.peak_rate_per_m2, peak_rate_per_m2(question, {5.0, 5.0, 4.0}) + 1e-4);
  EXPECT_NEAR(peak_rate_per_m2(question, {3.0, 3.0, 8.0}), 0.142, 0.001);
  EXPECT_LT(choice.peak_rate_per_m2, 0.0155);
}

// The road of a corner: lanes of half a width around both legs, long enough for the whole body.
std::vector<Vector2d> road_of(const CornerQuestion& question, double half_width_m) {
  const double w = half_width_m, l = -question.before.x() + 6.0;
  return {{-l, -w}, {w, -w}, {w, l}, {-w, l}, {-w, w}, {-l, w}};  // a right angle
}

TEST(CornerGaps, KeepTheSweptVehicleOnTheRoad) {
  CornerQuestion question = corner(30.0, 90.0, 3.0);
  const CornerChoice anywhere = choose_corner_gaps(question, VehicleShape{});
  ASSERT_TRUE(anywhere.gaps);
  double last_total_m = 1e300;
  for (const double half_width_m : {6.0, 3.0, 2.2}) {
    question.drivable = road_of(question, half_width_m);
    const CornerChoice choice = choose_corner_gaps(question, VehicleShape{});
    ASSERT_TRUE(choice.gaps) << half_width_m << " m: " << choice.reason;
    EXPECT_GE(choice.peak_rate_per_m2, anywhere.peak_rate_per_m2);
    EXPECT_LE(choice.gaps->total_m(), last_total_m);  // narrower roads allow shorter curves
    last_total_m = choice.gaps->total_m();
    const auto curve =
        QuinticBezier::corner(question.before, question.at, question.after, *choice.gaps);
    for (int i = 0; i <= 1000; ++i) {
      const Vector2d p = curve.at(i / 1000.0), t = curve.derivative(i / 1000.0, 1);
      const auto body = geometry::body_at({p.x(), p.y(), std::atan2(t.y(), t.x())}, VehicleShape{});
      const auto inner = geometry::distance_m(body, Vector2d(-half_width_m, half_width_m));
      EXPECT_GT(inner, 0.0) << half_width_m << " m";
      for (const Vector2d& at : body.corners()) {
        EXPECT_LT(at.x(), half_width_m + 0.01);
        EXPECT_GT(at.y(), -half_width_m - 0.01);
      }
    }
  }
}

TEST(CornerGaps, KeepToTheSteeringAndItsRate) {
  const VehicleShape vehicle;
  for (const double speed_mps : {2.0, 6.0, 10.0}) {
    const CornerChoice choice = choose_corner_gaps(corner(30.0, 110.0, speed_mps), vehicle);
    ASSERT_TRUE(choice.gaps) << choice.reason;
    EXPECT_LE(std::atan(vehicle.wheelbase_m * choice.peak_curvature_per_m),
              vehicle.max_steering_rad);
    // δ̇ ≤ L v κ′: the bound without the denominator would be stricter.
    const double bend = vehicle.wheelbase_m * choice.peak_curvature_per_m;
    EXPECT_LE(vehicle.wheelbase_m * speed_mps * choice.peak_rate_per_m2 / (1.0 + bend * bend),
              vehicle.max_steering_rate_radps);
  }
}

TEST(CornerGaps, SayWhyThereAreNone) {
  const CornerChoice short_legs = choose_corner_gaps(corner(2.0, 90.0, 10.0), VehicleShape{});
  EXPECT_FALSE(short_legs.gaps);
  EXPECT_NE(short_legs.reason.find("faster than the wheels turn at 10.0 m/s"), std::string::npos)
      << short_legs.reason;
  CornerQuestion narrow = corner(30.0, 90.0, 3.0);
  narrow.drivable = road_of(narrow, 0.7);  // narrower than the vehicle
  const CornerChoice none = choose_corner_gaps(narrow, VehicleShape{});
  EXPECT_FALSE(none.gaps);
  EXPECT_NE(none.reason.find("leave the drivable area"), std::string::npos) << none.reason;
}

TEST(CornerGaps, RefuseLegsWithoutLengthAndBadSpeeds) {
  EXPECT_THROW(choose_corner_gaps(corner(0.0, 90.0, 5.0), VehicleShape{}), std::invalid_argument);
  EXPECT_THROW(choose_corner_gaps(corner(9.0, 90.0, -1.0), VehicleShape{}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
