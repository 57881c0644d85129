#include "roadbed/planning/audit/swept_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace roadbed::planning {
namespace {

using geometry::Pose2;

TEST(SweptDrive, KeepsItsOffsetFromACircleAndItsSpeedAlongIt) {
  const double radius_m = 20.0;
  const auto circle = [&](double s_m) {
    const double angle = s_m / radius_m;
    return Pose2{radius_m * std::cos(angle), radius_m * std::sin(angle), angle + M_PI / 2};
  };
  const geometry::Trajectory drive =
      swept_along(circle, 30.2, {.speed_mps = 4.0, .offset_m = 1.5, .step_m = 0.5});
  EXPECT_EQ(drive.start_s(), 0.0);
  EXPECT_DOUBLE_EQ(drive.end_s(), 30.2 / 4.0);
  EXPECT_EQ(drive.points().size(), 62u);
  for (const auto& row : drive.points()) {
    EXPECT_NEAR(std::hypot(row.x_m, row.y_m), radius_m - 1.5, 1e-9);  // left is inwards
    EXPECT_NEAR(row.heading_rad, row.t_s * 4.0 / radius_m + M_PI / 2, 1e-9);
    EXPECT_NEAR(row.curvature_per_m, 1.0 / 18.5, 1e-4);
    EXPECT_EQ(row.speed_mps, 4.0);
  }
}

TEST(SweptDrive, EndsJustAtTheLengthAlsoWhereThatIsAMultipleOfTheStepButForRounding) {
  const auto line = [](double s_m) { return Pose2{s_m, 0, 0}; };
  for (int n = 1; n <= 60; ++n) {
    const double whole_m = 0.25 * n;
    for (const double length_m :
         {std::nextafter(whole_m, 0.0), whole_m, std::nextafter(whole_m, 100.0)}) {
      for (const double speed_kmh : {7.0, 30.0, 36.0, 50.0}) {
        const geometry::Trajectory drive =
            swept_along(line, length_m, {.speed_mps = speed_kmh / 3.6, .step_m = 0.25});
        EXPECT_EQ(drive.points().size(), static_cast<std::size_t>(n) + 1);
        EXPECT_EQ(drive.points().back().x_m, length_m);
        EXPECT_EQ(drive.end_s(), length_m / (speed_kmh / 3.6));
      }
    }
  }
}

TEST(SweptDrive, RefusesWhatIsNoSweep) {
  const auto line = [](double s_m) { return Pose2{s_m, 0, 0}; };
  EXPECT_THROW(swept_along(line, 0.0), std::invalid_argument);
  EXPECT_THROW(swept_along(line, NAN), std::invalid_argument);
  EXPECT_THROW(swept_along(line, 1.0, {.speed_mps = 0.0}), std::invalid_argument);
  EXPECT_THROW(swept_along(line, 1.0, {.step_m = -1.0}), std::invalid_argument);
  EXPECT_THROW(swept_along(line, 1.0, {.offset_m = INFINITY}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
