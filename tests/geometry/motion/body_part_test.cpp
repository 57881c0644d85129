#include "roadbed/geometry/motion/body_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace roadbed::geometry {
namespace {

TEST(BodyPart, OfAVehicleHasTheVehiclesCorners) {
  const VehicleShape shape;
  const BodyPart body = body_of(shape, 0.3);
  const Pose2 pose{3.0, -2.0, 0.7};
  const Ring outline = body.outline_at(pose);
  const auto corners = shape.corners_in_vehicle();
  ASSERT_EQ(outline.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((outline[i] - pose * corners[i]).norm(), 1e-12);
  EXPECT_EQ(body.from_height_m, 0.3);
  EXPECT_EQ(body.to_height_m, shape.height_m);
  EXPECT_NEAR(body.reach_m(), shape.reach_m(), 1e-12);
}

TEST(BodyPart, ReachAndCircumradiusHoldEveryCornerAndNoMore) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-3.0, 3.0), size(0.1, 2.0);
  const Pose2 pose{1.0, 2.0, 0.4};
  for (int i = 0; i < 100; ++i) {
    const double x = place(random), y = place(random);
    const bool is_round = i % 2 == 0;
    BodyPart part{.rear_m = x, .front_m = x, .right_m = y, .left_m = y, .radius_m = size(random)};
    if (!is_round) {
      part = {.rear_m = x, .front_m = x + size(random), .right_m = y, .left_m = y + size(random)};
    }
    part.check();
    double reach_m = 0.0, radius_m = 0.0;
    for (const Eigen::Vector2d& corner : part.outline_at(pose)) {
      reach_m = std::max(reach_m, (corner - pose.position()).norm());
      radius_m = std::max(radius_m, (corner - pose * part.middle_in_vehicle()).norm());
    }
    EXPECT_GE(part.reach_m(), reach_m - 1e-12);
    EXPECT_LE(part.reach_m(), reach_m + (is_round ? 0.02 : 1e-12));
    EXPECT_NEAR(part.circumradius_m(), radius_m, 1e-12);
  }
}

TEST(BodyPart, GrownByAMarginHasItOnEverySide) {
  const BodyPart box{.rear_m = 1.0, .front_m = 2.0, .right_m = -0.5, .left_m = 0.25};
  const BodyPart grown = inflated(box, 0.1);
  EXPECT_NEAR(grown.rear_m, 0.9, 1e-15);
  EXPECT_NEAR(grown.front_m, 2.1, 1e-15);
  EXPECT_NEAR(grown.right_m, -0.6, 1e-15);
  EXPECT_NEAR(grown.left_m, 0.35, 1e-15);
  const BodyPart circle{.radius_m = 0.5};
  EXPECT_NEAR(inflated(circle, 0.1).radius_m, 0.6, 1e-15);
  EXPECT_EQ(inflated(circle, 0.1).front_m, 0.0);
}

TEST(BodyPart, RefusesWhatHasNoExtent) {
  const BodyPart box{.rear_m = 1.0, .front_m = 2.0, .right_m = -0.5, .left_m = 0.25};
  EXPECT_NO_THROW(box.check());
  const auto refuse = [&](double BodyPart::*measure, double value) {
    BodyPart part = box;
    part.*measure = value;
    EXPECT_THROW(part.check(), std::invalid_argument) << value;
  };
  refuse(&BodyPart::front_m, 1.0);
  refuse(&BodyPart::left_m, -0.5);
  refuse(&BodyPart::radius_m, -0.1);
  refuse(&BodyPart::radius_m, 0.1);
  refuse(&BodyPart::to_height_m, 0.2);
  refuse(&BodyPart::rear_m, std::nan(""));
  refuse(&BodyPart::to_height_m, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace roadbed::geometry
