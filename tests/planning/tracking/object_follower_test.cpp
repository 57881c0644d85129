#include "roadbed/planning/tracking/object_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "roadbed/tests/support/made_street.h"

namespace roadbed::planning {
namespace {

using geometry::Rectangle;
using tests::rectangle;

TEST(ObjectFollower, KeepsWhoIsWhoWhereTheyPassEachOther) {
  ObjectFollower follower;
  std::mt19937 random(3);
  std::normal_distribution<double> noise_m(0.0, 0.05);
  for (int k = 0; k < 40; ++k) {
    const double t = 0.1 * k;
    std::vector<Rectangle> seen{rectangle(12.0 * t, 0.0, 0.0, 4.5, 1.8),
                                rectangle(50.0 - 10.0 * t, 3.5, 0.0, 4.2, 1.8),
                                rectangle(25.0, -4.0, 0.0, 4.4, 1.7)};
    for (Rectangle& box : seen) box.centre += Eigen::Vector2d(noise_m(random), noise_m(random));
    if (k % 2 == 1) std::swap(seen[0], seen[2]);  // clusters come in any order
    follower.observe(t, seen);
  }
  const std::vector<ObstacleInSource> found = follower.obstacles();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0].pose_at(3.9).x_m, 46.8, 0.3);
  EXPECT_NEAR(found[1].pose_at(3.9).x_m, 11.0, 0.3);
  EXPECT_NEAR(std::cos(found[0].pose_at(2.0).heading_rad), 1.0, 1e-9);
  EXPECT_NEAR(std::cos(found[1].pose_at(2.0).heading_rad), -1.0, 1e-9);  // to where it moves
  EXPECT_TRUE(found[2].is_static());
  EXPECT_EQ(found[2].id, "object 3");
}

TEST(ObjectFollower, HoldsEverySightOfAnObject) {
  ObjectFollower follower;
  std::vector<Rectangle> turning;
  for (int k = 0; k < 30; ++k) {
    const double angle = 0.05 * k;  // round a bend of 20 m, the box with any of its axes
    turning.push_back(rectangle(20.0 * std::sin(angle), 20.0 * (1.0 - std::cos(angle)),
                                angle + (k % 3) * M_PI, 4.5, 1.8));
    follower.observe(0.1 * k, std::span(&turning.back(), 1));
  }
  const std::vector<ObstacleInSource> found = follower.obstacles();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].length_m, 4.5, 1e-9);
  EXPECT_NEAR(found[0].width_m, 1.8, 1e-9);
  for (std::size_t k = 0; k < turning.size(); ++k) {
    const Rectangle held = rectangle_at(found[0], 0.1 * static_cast<double>(k));
    for (const Eigen::Vector2d& corner : turning[k].corners()) {
      EXPECT_LT(geometry::distance_m(held, corner), 1e-6) << k;
    }
  }
}

// Of a parked car more is seen as one drives by: one end moves, the other does not.
TEST(ObjectFollower, DoesNotTakeForMovingWhatIsSeenMoreAndMoreOf) {
  ObjectFollower follower;
  for (int k = 0; k < 20; ++k) {
    const double length_m = 1.0 + 0.18 * k;
    const Rectangle seen = rectangle(10.0 + 0.5 * length_m, 3.0, 0.0, length_m, 1.8);
    follower.observe(0.1 * k, std::span(&seen, 1));
  }
  const std::vector<ObstacleInSource> found = follower.obstacles();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_static());
  EXPECT_NEAR(found[0].length_m, 1.0 + 0.18 * 19, 1e-9);
  EXPECT_EQ(found[0].validity.from_s, kAlways.from_s);
}

TEST(ObjectFollower, LetsGoOfWhatIsNotSeenForLong) {
  ObjectFollower follower({.coasts_for_s = 0.25});
  const Rectangle car = rectangle(0, 0, 0, 4.5, 1.8);
  const auto see = [&](double t_s, std::size_t count) {
    follower.observe(t_s, std::span(&car, count));
  };
  see(0.0, 1), see(0.1, 0), see(0.2, 1), see(0.3, 0), see(0.4, 0), see(0.5, 1);
  ASSERT_EQ(follower.objects().size(), 2u);
  EXPECT_EQ(follower.objects()[0].sights.size(), 2u);
}

TEST(ObjectFollower, HasWhatWasSeenOnceThereUntilItIsNotSeen) {
  ObjectFollower follower;
  const std::vector<Rectangle> bird{rectangle(0, 0, 0, 1, 1)};
  follower.observe(1.0, {});
  follower.observe(1.1, bird);
  follower.observe(1.25, {});
  const std::vector<ObstacleInSource> found = follower.obstacles();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].validity.from_s, 1.1);
  EXPECT_EQ(found[0].validity.to_s, 1.25);
}

TEST(ObjectFollower, OfOneTimeHasAllStandForEver) {
  ObjectFollower follower;
  follower.observe(0.0, std::vector<Rectangle>{rectangle(0, 0, 0, 4.5, 1.8)});
  ASSERT_EQ(follower.obstacles().size(), 1u);
  EXPECT_TRUE(follower.obstacles()[0].is_static());
}

TEST(ObjectFollower, RefusesATimeThatIsNotLater) {
  ObjectFollower follower;
  follower.observe(1.0, {});
  EXPECT_THROW(follower.observe(1.0, {}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
