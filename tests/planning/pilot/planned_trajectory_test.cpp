#include "roadbed/planning/pilot/planned_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning {
namespace {

constexpr double kRadius_m = 30.0;

/// A quarter circle to the left, from the origin along x.
ReferenceLine bend() {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.05 * i;
    points.emplace_back(kRadius_m * std::sin(angle), kRadius_m * (1.0 - std::cos(angle)));
  }
  return ReferenceLine::through(points, 3.0, 14.0);
}

std::vector<SpeedState> steady(double speed_mps, double duration_s) {
  std::vector<SpeedState> drive;
  for (int k = 0; 0.1 * k <= duration_s + 1e-9; ++k) {
    drive.push_back({.t_s = 0.1 * k, .ahead_m = 0.1 * k * speed_mps, .speed_mps = speed_mps});
  }
  return drive;
}

PlannerCommand decision(std::vector<SpeedState> drive) {
  PlannerCommand command;
  command.drive = std::move(drive);
  command.set_speed_mps = 10.0;
  return command;
}

// Metres driven are those of the path, not of its line: to the left of a left bend there are fewer
// of them.
TEST(PlannedTrajectory, DrivesThePathAtItsSpeeds) {
  const ReferenceLine line = bend();
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m, .d_m = 2.0}; });
  const geometry::Trajectory driven = planned_trajectory(
      {path, 5.0}, 7.0, {.speed_mps = 6.0}, decision(steady(6.0, 3.0)), geometry::VehicleShape{});
  EXPECT_EQ(driven.start_s(), 7.0);
  const Eigen::Vector2d centre(0.0, kRadius_m);
  double way_m = 0.0;
  for (double t = 7.0; t < 9.95; t += 0.1) {
    const geometry::TrajectoryPoint a = driven.at(t), b = driven.at(t + 0.1);
    way_m += (b.pose().position() - a.pose().position()).norm();
    EXPECT_NEAR((a.pose().position() - centre).norm(), kRadius_m - 2.0, 0.02) << t;
    EXPECT_NEAR(a.curvature_per_m, 1.0 / (kRadius_m - 2.0), 5e-4);
    EXPECT_NEAR(std::tan(a.steering_rad), geometry::VehicleShape{}.wheelbase_m * a.curvature_per_m,
                1e-12);
  }
  EXPECT_NEAR(way_m, 18.0, 0.02);
}

/// As the search for a speed gives it: a state every 0.5 s, speeding up by 2 m/s².
TEST(PlannedTrajectory, HasARowEveryTenthOfASecondWhateverTheDriveHas) {
  const ReferenceLine line = bend();
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  std::vector<SpeedState> drive;
  for (double t_s = 0.0; t_s <= 2.0; t_s += 0.5) {
    drive.push_back({t_s, 4.0 * t_s + t_s * t_s, 4.0 + 2.0 * t_s, 2.0, 2.0});
  }
  const geometry::Trajectory driven = planned_trajectory({path, 0.0}, 0.0, {.speed_mps = 4.0},
                                                         decision(drive), geometry::VehicleShape{});
  for (std::size_t k = 1; k <= 20; ++k) {
    const geometry::TrajectoryPoint &a = driven.points()[k - 1], &b = driven.points()[k];
    EXPECT_NEAR(b.t_s, 0.1 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(b.speed_mps, 4.0 + 2.0 * b.t_s, 1e-9);
    EXPECT_NEAR((b.pose().position() - a.pose().position()).norm(),
                0.05 * (a.speed_mps + b.speed_mps), 0.002);
  }
}

TEST(PlannedTrajectory, EndsInAStop) {
  const ReferenceLine line = bend();
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  const geometry::Trajectory driven = planned_trajectory(
      {path, 0.0}, 0.0, {.speed_mps = 6.0}, decision(steady(6.0, 2.0)), geometry::VehicleShape{});
  EXPECT_EQ(driven.points().back().speed_mps, 0.0);
  EXPECT_NEAR(driven.end_s(), 2.0 + 6.0 / 3.0, 0.11);
  double way_m = 0.0;
  for (std::size_t i = 1; i < driven.points().size(); ++i) {
    way_m +=
        (driven.points()[i].pose().position() - driven.points()[i - 1].pose().position()).norm();
  }
  EXPECT_NEAR(way_m, 6.0 * 2.0 + 36.0 / 6.0, 0.1);
}

// A drive of 5 s at 20 m/s and a stop at 3 m/s² take 167 m.
TEST(PlannedTrajectory, StopsBeforeWhereItHasToHaveStopped) {
  const ReferenceLine line = ReferenceLine::through({{0, 0}, {400, 0}}, 3.0, 30.0);
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  PlannerCommand gentle = decision(steady(20.0, 5.0));
  gentle.acceleration_mps2 = -1.3;  // alone it leads 154 m on
  for (const PlannerCommand& command : {decision(steady(20.0, 5.0)), gentle}) {
    for (const double to_s_m : {30.0, 80.0, 98.0, 140.0, 160.0}) {
      SCOPED_TRACE(testing::Message() << to_s_m << " m");
      const geometry::Trajectory driven = planned_trajectory(
          {path, 5.0, 5.0 + to_s_m}, 0.0, {.speed_mps = 20.0}, command, geometry::VehicleShape{});
      EXPECT_LT(driven.points().back().x_m, 5.0 + to_s_m + 0.1);
      EXPECT_EQ(driven.points().back().speed_mps, 0.0);
      const double needed_mps2 = 20.0 * 20.0 / (2.0 * to_s_m);
      double hardest_mps2 = 0.0;
      for (const auto& row : driven.points()) {
        hardest_mps2 = std::max(hardest_mps2, -row.acceleration_mps2);
      }
      EXPECT_LT(hardest_mps2, std::max(3.0, needed_mps2) + 0.2);  // no harder than it takes
    }
  }
}

TEST(PlannedTrajectory, BrakesAtOnceWhereThatIsDecided) {
  const ReferenceLine line = bend();
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  PlannerCommand emergency = decision(steady(8.0, 3.0));
  emergency.acceleration_mps2 = -6.0;
  const geometry::Trajectory driven =
      planned_trajectory({path, 0.0}, 0.0, {.speed_mps = 8.0}, emergency, geometry::VehicleShape{});
  EXPECT_NEAR(driven.end_s(), 8.0 / 6.0, 0.11);
  EXPECT_EQ(driven.points().back().speed_mps, 0.0);
}

// What was foreseen is of a path that is given up: nobody creeps on along it.
// A bend of 30 m that begins 20 m ahead, at 14 m/s: 6.5 m/s² to the side if it is braked for
// softly.
TEST(PlannedTrajectory, BrakesHarderBeforeABend) {
  std::vector<Eigen::Vector2d> points;
  for (double x_m = -60.0; x_m < -1.0; x_m += 2.0) points.emplace_back(x_m, 0.0);
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.05 * i;
    points.emplace_back(kRadius_m * std::sin(angle), kRadius_m * (1.0 - std::cos(angle)));
  }
  const ReferenceLine line = ReferenceLine::through(points, 3.0, 14.0);
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  PlannerCommand softly = decision(steady(14.0, 3.0));
  softly.acceleration_mps2 = -0.6;
  const geometry::Trajectory driven =
      planned_trajectory({path, 40.0}, 0.0, {.speed_mps = 14.0}, softly, geometry::VehicleShape{});
  for (const geometry::TrajectoryPoint& row : driven.points()) {
    EXPECT_LT(row.speed_mps * row.speed_mps * std::abs(row.curvature_per_m), 3.05) << row.t_s;
  }
  EXPECT_EQ(driven.points().back().speed_mps, 0.0);
}

TEST(PlannedTrajectory, StopsWhereNoSpeedIsWanted) {
  const ReferenceLine line = bend();
  const PlannedPath path(line, [](double s_m) { return LateralState{.s_m = s_m}; });
  PlannerCommand stop = decision(steady(0.4, 3.0));
  stop.set_speed_mps = 0.0;
  stop.acceleration_mps2 = -0.1;
  const geometry::Trajectory driven =
      planned_trajectory({path, 5.0}, 7.0, {.speed_mps = 0.4}, stop, geometry::VehicleShape{});
  EXPECT_NEAR(driven.at(7.2).speed_mps, 0.2, 1e-9);
  EXPECT_LT(driven.end_s(), 7.55);
  EXPECT_EQ(driven.points().back().speed_mps, 0.0);
}

TEST(PlannedTrajectory, ThenBrakesAsHardAsTheLeadAsksFor) {
  const std::vector<SpeedState> drive = steady(10.0, 5.0);
  EXPECT_EQ(braking_after_mps2(drive, {}), 3.0);
  EXPECT_EQ(braking_after_mps2(drive, DriveLead{"far", 200.0, 10.0}), 3.0);
  EXPECT_EQ(braking_after_mps2(drive, DriveLead{"touched", 0.0, 2.0}), 8.0);
  // After 5 s 10 m behind who drives as fast: it comes to rest 6.25 m on, 1 m is kept.
  EXPECT_NEAR(braking_after_mps2(drive, DriveLead{"near", 10.0, 10.0}),
              100.0 / (2.0 * (10.0 + 6.25 - 1.0)), 1e-12);
}

TEST(StoppingTrajectory, IsStraightAndStops) {
  const geometry::Trajectory driven =
      stopping_trajectory(3.0, {.map_from_vehicle = {1.0, 2.0, 0.5}, .speed_mps = 9.0});
  const Eigen::Vector2d moved =
      driven.points().back().pose().position() - Eigen::Vector2d(1.0, 2.0);
  EXPECT_NEAR(moved.norm(), 81.0 / 6.0, 0.05);
  EXPECT_NEAR(std::atan2(moved.y(), moved.x()), 0.5, 1e-12);
  EXPECT_EQ(driven.points().back().speed_mps, 0.0);
  EXPECT_EQ(stopping_trajectory(0.0, {}).points().size(), 1u);
}

}  // namespace
}  // namespace roadbed::planning
