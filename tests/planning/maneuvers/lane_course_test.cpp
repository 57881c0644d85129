#include "roadbed/planning/maneuvers/lane_course.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace roadbed::planning {
namespace {

using testing::ElementsAre;

Obstacle car(double x_m, double y_m, double heading_rad, double speed_mps) {
  const geometry::TrajectoryPoint now{
      .x_m = x_m, .y_m = y_m, .heading_rad = heading_rad, .speed_mps = speed_mps};
  geometry::TrajectoryPoint later = now;
  later.t_s = 5.0;
  later.x_m += 5.0 * speed_mps * std::cos(heading_rad);
  later.y_m += 5.0 * speed_mps * std::sin(heading_rad);
  return {.id = "car", .motion = geometry::Trajectory({now, later})};
}

// A lane that turns across others.
TEST(MoversOnLane, AreThoseWhoDriveAlongItOrStand) {
  const geometry::Polyline lane({{0, 0}, {100, 0}});
  const double across = 0.5 * std::numbers::pi;
  const std::vector<Obstacle> others{
      car(10, 0.5, 0.0, 8.0),    car(20, 0.0, std::numbers::pi, 8.0),  // oncoming
      car(30, 0.0, across, 8.0), car(40, 0.0, across, 0.0),  // crossing, and stopped there
      car(50, 0.0, 0.5, 8.0),    car(60, 3.0, 0.0, 8.0),     // joining, and in another lane
  };
  std::vector<std::size_t> found;
  for (const MoverOnLane& mover : movers_on_lane(lane, {others}, 0.0, 1.6)) {
    found.push_back(mover.obstacle);
    EXPECT_GE(mover.speed_mps, -1e-9);
  }
  EXPECT_THAT(found, ElementsAre(0, 3, 4));
}

}  // namespace
}  // namespace roadbed::planning
