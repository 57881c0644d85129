#include "roadbed/planning/obstacles/visibility.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "roadbed/tests/support/straight_world.h"

namespace roadbed::planning {
namespace {

using geometry::Rectangle;

Rectangle rectangle(double x_m, double y_m, double heading_rad, double length_m, double width_m) {
  return {.centre = {x_m, y_m},
          .axis = {std::cos(heading_rad), std::sin(heading_rad)},
          .half_length_m = 0.5 * length_m,
          .half_width_m = 0.5 * width_m};
}

/// Inside a rectangle that is larger by a margin all around.
bool holds(const Rectangle& body, const Eigen::Vector2d& point, double margin_m) {
  const Eigen::Vector2d to = point - body.centre;
  const double along_m = to.x() * body.axis.x() + to.y() * body.axis.y();
  const double beside_m = to.y() * body.axis.x() - to.x() * body.axis.y();
  return std::abs(along_m) <= body.half_length_m + margin_m &&
         std::abs(beside_m) <= body.half_width_m + margin_m;
}

/// Whether any point of a line, looked at every centimetre, is in one of the bodies.
bool is_cut(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
            const std::vector<Rectangle>& bodies, double margin_m) {
  const int steps = static_cast<int>(std::ceil((to - from).norm() / 0.01));
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector2d point = from + (to - from) * k / steps;
    for (const Rectangle& body : bodies) {
      if (holds(body, point, margin_m)) return true;
    }
  }
  return false;
}

class Visibilities : public testing::Test {
 protected:
  Visibility from(const Rectangle& vehicle, std::vector<Rectangle> others,
                  double range_m = 1000.0) const {
    return {vehicle, range_m, std::move(others), nullptr, world_.road_map};
  }

  tools::World world_ = tests::straight_world({}, {});
};

TEST_F(Visibilities, ArePointsThatNoBodyCutsOffFromBothMirrors) {
  std::mt19937 random(7);
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const Rectangle vehicle = rectangle(0.0, 0.0, 0.4, 4.6, 1.9);
  // Half way to the front, at both sides: 1.15 m ahead, 0.95 m beside the middle.
  const Eigen::Rotation2Dd turned(0.4);
  const Eigen::Vector2d left = turned * Eigen::Vector2d(1.15, 0.95),
                        right = turned * Eigen::Vector2d(1.15, -0.95);
  int seen = 0, hidden = 0, unclear = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<Rectangle> others;
    for (int i = 0; i < 4; ++i) {
      const double angle = uniform(-std::numbers::pi, std::numbers::pi), away = uniform(6.0, 25.0);
      others.push_back(rectangle(away * std::cos(angle), away * std::sin(angle), uniform(-3.0, 3.0),
                                 uniform(1.0, 12.0), uniform(0.5, 2.5)));
    }
    const Eigen::Vector2d point{uniform(-40.0, 40.0), uniform(-40.0, 40.0)};
    const bool surely = !is_cut(left, point, others, 0.02) || !is_cut(right, point, others, 0.02);
    const bool maybe = !is_cut(left, point, others, -0.02) || !is_cut(right, point, others, -0.02);
    if (surely != maybe) {
      ++unclear;  // it grazes a body
      continue;
    }
    EXPECT_EQ(from(vehicle, others).sees(point), surely) << k;
    ++(surely ? seen : hidden);
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(hidden, 300);
  EXPECT_LT(unclear, 100);
}

TEST_F(Visibilities, EndAtTheRange) {
  const Visibility sight = from(rectangle(0.0, 0.0, 0.0, 4.0, 2.0), {}, 50.0);
  EXPECT_TRUE(sight.sees({50.9, 0.0}));  // the mirrors are a metre ahead
  EXPECT_FALSE(sight.sees({51.1, 0.0}));
}

TEST_F(Visibilities, SeeABodyOfWhichACornerLooksOut) {
  const Rectangle vehicle = rectangle(0.0, 0.0, 0.0, 4.0, 2.0);
  // From the left mirror, one metre left and ahead, the line past the lorry's corner (13, 1.25)
  // rises by 1 in 48: 40 m away whoever reaches beyond 1.81 m is seen.
  const Rectangle lorry = rectangle(18.0, 0.0, 0.0, 10.0, 2.5);
  const auto sees_car_at = [&](double y_m) {
    return from(vehicle, {lorry, rectangle(42.0, y_m, 0.0, 4.0, 1.8)}).sees_other(1);
  };
  EXPECT_FALSE(sees_car_at(0.0));
  EXPECT_FALSE(sees_car_at(0.8));
  EXPECT_TRUE(sees_car_at(1.0));
  EXPECT_TRUE(from(vehicle, {lorry}).sees_other(0)) << "nobody hides himself";
}

TEST_F(Visibilities, KnowWhoStandsWhere) {
  const Visibility sight =
      from(rectangle(0.0, 0.0, 0.0, 4.0, 2.0), {rectangle(20.0, 0.0, 0.0, 4.0, 2.0)});
  EXPECT_TRUE(sight.is_on_body({22.4, 0.0}));
  EXPECT_FALSE(sight.is_on_body({22.6, 0.0}));
}

}  // namespace
}  // namespace roadbed::planning
