#include "roadbed/tools/report/derived_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace roadbed::tools {
namespace {

using geometry::Trajectory;
using geometry::TrajectoryPoint;

constexpr double kWheelbase_m = 2.5;

Trajectory drive_of(const std::vector<double>& times_s, const std::function<double(double)>& speed,
                    const std::function<double(double)>& heading) {
  std::vector<TrajectoryPoint> rows;
  for (const double t_s : times_s) {
    rows.push_back({.t_s = t_s, .heading_rad = heading(t_s), .speed_mps = speed(t_s)});
  }
  return Trajectory(std::move(rows));
}

std::vector<double> every(double step_s, int count) {
  std::vector<double> times_s;
  for (int k = 0; k < count; ++k) times_s.push_back(step_s * k);
  return times_s;
}

TEST(WithDynamics, OfConstantAccelerationAndYawRateIsExactUpToTheEnds) {
  const auto speed = [](double t_s) { return 5.0 + 1.5 * t_s; };
  const auto heading = [](double t_s) { return 3.0 + 0.2 * t_s; };
  for (const std::vector<double>& times_s :
       {every(0.01, 300), every(0.1, 40), every(1.0, 5), std::vector{0.0, 0.1, 0.15, 0.9, 3.0}}) {
    const Trajectory drive = with_dynamics(drive_of(times_s, speed, heading), kWheelbase_m);
    for (const TrajectoryPoint& row : drive.points()) {
      EXPECT_NEAR(row.acceleration_mps2, 1.5, 1e-11) << row.t_s;
      EXPECT_NEAR(row.curvature_per_m, 0.2 / speed(row.t_s), 1e-12) << row.t_s;
      EXPECT_NEAR(std::tan(row.steering_rad), kWheelbase_m * 0.2 / speed(row.t_s), 1e-11);
    }
  }
}

// Differences from row to row would say ±2 m/s² and more.
TEST(WithDynamics, NoiseFromRowToRowHardlyCounts) {
  int row = 0;
  const auto noisy = [&](double t_s) { return 10.0 + t_s + (row++ % 2 == 0 ? 0.01 : -0.01); };
  const Trajectory drive =
      with_dynamics(drive_of(every(0.01, 300), noisy, [](double) { return 0.0; }), kWheelbase_m);
  for (std::size_t i = 50; i < 250; ++i) {
    EXPECT_NEAR(drive.points()[i].acceleration_mps2, 1.0, 0.01);
  }
}

TEST(WithDynamics, OfWhoStandsHasNoCurvature) {
  const Trajectory drive =
      with_dynamics(drive_of(
                        every(0.1, 20), [](double) { return 0.1; }, [](double t_s) { return t_s; }),
                    kWheelbase_m);
  for (const TrajectoryPoint& row : drive.points()) {
    EXPECT_EQ(row.curvature_per_m, 0.0);
    EXPECT_EQ(row.steering_rad, 0.0);
  }
}

TEST(WithDynamics, ThatTheFileTellsStay) {
  const Trajectory told(
      {{.t_s = 0.0, .speed_mps = 1.0}, {.t_s = 1.0, .speed_mps = 9.0, .acceleration_mps2 = 0.5}});
  EXPECT_EQ(with_dynamics(told, kWheelbase_m).points()[0].acceleration_mps2, 0.0);
  EXPECT_EQ(with_dynamics(told, kWheelbase_m).points()[1].acceleration_mps2, 0.5);
}

TEST(WithDynamics, OfASingleRowAreNone) {
  const Trajectory single({{.t_s = 2.0, .speed_mps = 3.0}});
  EXPECT_EQ(with_dynamics(single, kWheelbase_m).points()[0].acceleration_mps2, 0.0);
  EXPECT_EQ(with_dynamics(single, kWheelbase_m).points()[0].curvature_per_m, 0.0);
}

}  // namespace
}  // namespace roadbed::tools
