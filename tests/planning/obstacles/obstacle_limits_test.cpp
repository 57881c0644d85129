#include "roadbed/planning/obstacles/obstacle_limits.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "roadbed/map/files/input_error.h"

namespace roadbed::planning {
namespace {

ObstacleInSource to_and_fro(std::size_t poses, double step_s, double step_m) {
  std::vector<geometry::TrajectoryPoint> points;
  for (std::size_t i = 0; i < poses; ++i) {
    points.push_back({.t_s = step_s * static_cast<double>(i), .x_m = i % 2 == 0 ? 0.0 : step_m});
  }
  return {.id = "a", .motion = geometry::Trajectory(std::move(points))};
}

bool is_refused(const std::vector<ObstacleInSource>& obstacles) {
  try {
    refuse_endless_ways(std::span(obstacles), "test");
  } catch (const map::InputError&) {
    return true;
  }
  return false;
}

// 200 km for all, and 20 m for each pose.
TEST(ObstacleLimits, WaysMayGrowWithThePosesOnly) {
  EXPECT_FALSE(is_refused({to_and_fro(2, 1e4, 200'000.0)}));
  EXPECT_TRUE(is_refused({to_and_fro(2, 1e4, 200'041.0)}));
  EXPECT_TRUE(is_refused(std::vector(3, to_and_fro(2, 1e4, 100'000.0))));
  EXPECT_FALSE(is_refused({to_and_fro(100'000, 0.1, 20.0)}));
  EXPECT_TRUE(is_refused({to_and_fro(100'000, 0.1, 25.0)}));
}

TEST(ObstacleLimits, PosesAreAMicrosecondApart) {
  EXPECT_FALSE(is_refused({to_and_fro(3, 1.001e-6, 1.0)}));
  EXPECT_TRUE(is_refused({to_and_fro(3, 0.9e-6, 1.0)}));
}

}  // namespace
}  // namespace roadbed::planning
