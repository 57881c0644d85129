#include "roadbed/planning/speed/st_picture.h"

#include <gtest/gtest.h>

#include <vector>

#include "roadbed/tests/support/straight_profile.h"

namespace roadbed::planning {
namespace {

// A car of 4 m drives ahead at 6 m/s, its rear 10 m before the vehicle's front; one stands 300 m
// on.
std::vector<Obstacle> others() {
  Obstacle ahead{.id = "ahead", .length_m = 4.0, .width_m = 1.8, .motion = {}};
  const double x_m = geometry::VehicleShape{}.front_m() + 12.0;
  ahead.motion = geometry::Trajectory({{.t_s = 0.0, .x_m = x_m, .speed_mps = 6.0},
                                       {.t_s = 9.0, .x_m = x_m + 54.0, .speed_mps = 6.0}});
  Obstacle far{.id = "far", .length_m = 4.0, .width_m = 1.8, .motion = {}};
  far.motion = geometry::Trajectory(std::vector<geometry::TrajectoryPoint>{{.x_m = 150.0}});
  return {far, ahead};
}

std::vector<SpeedState> drive_at(double speed_mps, double until_s) {
  std::vector<SpeedState> drive;
  for (double t_s = 0.0; t_s <= until_s + 1e-9; t_s += 0.1) {
    drive.push_back({.t_s = t_s, .ahead_m = speed_mps * t_s, .speed_mps = speed_mps});
  }
  return drive;
}

TEST(StPicture, ShowsWhereTheDriveAndThoseInItsWayAreEveryHalfSecond) {
  const std::vector<Obstacle> obstacles = others();
  const StGraph graph(tests::straight_profile(10.0), Traffic{obstacles}, 0.0, 60, 0.0);
  const StPicture picture = st_picture(graph, drive_at(8.0, 4.0));
  ASSERT_EQ(picture.drive_m.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(picture.drive_m[i], 4.0 * static_cast<double>(i), 1e-4);
  ASSERT_EQ(picture.parts.size(), 9u) << "the one far ahead is left out";
  for (const StPicture::Part& part : picture.parts) {
    EXPECT_EQ(part.obstacle, 1u);
    EXPECT_NEAR(part.from_m, 10.0 + 3.0 * part.step, 0.51) << "samples are 0.5 m apart";
  }
}

TEST(StPicture, HasLightsAndEndsWithTheDrive) {
  StGraph graph(tests::straight_profile(10.0), Traffic{}, 0.0, 60, 0.0);
  graph.block(20, 30.0, 200.0);
  const StPicture picture = st_picture(graph, drive_at(8.0, 2.2));
  EXPECT_EQ(picture.drive_m.size(), 5u);
  ASSERT_EQ(picture.parts.size(), 1u);
  EXPECT_EQ(picture.parts[0].step, 4u);
  EXPECT_EQ(picture.parts[0].obstacle, StInterval::kNoObstacle);
  EXPECT_NEAR(picture.parts[0].to_m, 8.0 * 2.2 + 40.0, 1e-4) << "40 m past the drive";
}

TEST(StPicture, OfNoDriveIsEmpty) {
  const StGraph graph(tests::straight_profile(10.0), Traffic{}, 0.0, 10, 0.0);
  EXPECT_TRUE(st_picture(graph, {}).drive_m.empty());
}

}  // namespace
}  // namespace roadbed::planning
