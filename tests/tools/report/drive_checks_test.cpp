#include "roadbed/tools/report/from_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::tools {
namespace {

// Ten seconds at 10 m/s through a bend, 0.8 m from something at 4 s.
Drive good_drive() {
  Drive drive;
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= 100; ++i) {
    const double t_s = 0.1 * i;
    points.push_back({.t_s = t_s,
                      .x_m = 10.0 * t_s,
                      .speed_mps = 10.0,
                      .acceleration_mps2 = 1.5 * std::sin(t_s),
                      .curvature_per_m = 0.02});
    drive.samples.push_back({.t_s = t_s,
                             .set_speed_mps = 12.0,
                             .speed_limit_mps = 9.8,
                             .cross_track_m = i == 30 ? -0.21 : 0.05,
                             .clearance_m = 0.8 + 5.0 * std::abs(t_s - 4.0)});
  }
  drive.trajectory = geometry::Trajectory(points);
  drive.verdict = {Outcome::goal_reached, 10.0, "goal reached"};
  return drive;
}

ReportCheck check_named(const Drive& drive, const std::string& name,
                        const std::optional<planning::AuditReport>& audit = std::nullopt) {
  const auto checks = drive_checks(drive, audit);
  const auto found = std::ranges::find(checks, name, &ReportCheck::name);
  EXPECT_NE(found, checks.end()) << name;
  return found == checks.end() ? ReportCheck{} : *found;
}

TEST(DriveChecks, PassForAGoodDrive) {
  for (const ReportCheck& check : drive_checks(good_drive(), std::nullopt)) {
    EXPECT_TRUE(check.passed) << check.name;
  }
}

TEST(DriveChecks, TellTheWorstValueAndItsTime) {
  const ReportCheck clearance = check_named(good_drive(), "least clearance to obstacles");
  EXPECT_NEAR(*clearance.value, 0.8, 1e-9);
  EXPECT_NEAR(*clearance.at_s, 4.0, 1e-9);
  EXPECT_NEAR(*check_named(good_drive(), "largest lateral acceleration").value, 2.0, 1e-9);
  EXPECT_NEAR(*check_named(good_drive(), "largest yaw rate").value, 0.2, 1e-9);
  EXPECT_NEAR(*check_named(good_drive(), "speed above the limit").value, 0.2, 1e-9);
  const ReportCheck error = check_named(good_drive(), "largest cross-track error");
  EXPECT_NEAR(*error.value, 0.21, 1e-9);
  EXPECT_NEAR(*error.at_s, 3.0, 1e-9);
  EXPECT_TRUE(error.bound.empty());
}

TEST(DriveChecks, FailForWhatIsBad) {
  Drive drive = good_drive();
  drive.verdict.outcome = Outcome::collision;
  drive.samples[40].clearance_m = 0.0;
  drive.samples[50].off_road_m = 0.1;
  drive.samples[60].speed_limit_mps = 8.3;
  for (const char* name : {"goal reached", "least clearance to obstacles", "farthest off the road",
                           "speed above the limit"}) {
    EXPECT_FALSE(check_named(drive, name).passed) << name;
  }
}

TEST(DriveChecks, TellBrakingFromSpeedingUp) {
  Drive drive = good_drive();
  auto points = drive.trajectory.points();
  points[20].acceleration_mps2 = -4.2;
  points[70].acceleration_mps2 = 2.3;
  drive.trajectory = geometry::Trajectory(points);
  EXPECT_FALSE(check_named(drive, "strongest braking").passed);
  EXPECT_NEAR(*check_named(drive, "strongest braking").value, 4.2, 1e-9);
  EXPECT_TRUE(check_named(drive, "strongest acceleration").passed);
  EXPECT_NEAR(*check_named(drive, "strongest acceleration").at_s, 7.0, 1e-9);
}

TEST(DriveChecks, NameNoDistanceWhereThereIsNoObstacle) {
  Drive drive = good_drive();
  for (DriveSample& sample : drive.samples) {
    sample.clearance_m = std::numeric_limits<double>::infinity();
  }
  const ReportCheck check = check_named(drive, "least clearance to obstacles");
  EXPECT_FALSE(check.value);
  EXPECT_TRUE(check.passed);
}

TEST(DriveChecks, FollowTheAuditsVerdict) {
  planning::AuditReport audit;
  audit.verdict = planning::Verdict::conflict;
  EXPECT_FALSE(check_named(good_drive(), "least clearance to occupied space", audit).passed);
  audit.verdict = planning::Verdict::clear;
  EXPECT_TRUE(check_named(good_drive(), "least clearance to occupied space", audit).passed);
}

TEST(DriveChecks, OfNoDriveLookAtItsOutcomeOnly) {
  const auto checks = drive_checks({}, std::nullopt);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_FALSE(checks[0].passed);
}

TEST(DrivePlots, HaveOneValuePerRow) {
  for (const ReportPlot& plot : drive_plots(good_drive(), std::nullopt)) {
    EXPECT_EQ(plot.t_s.size(), 101U);
    for (const ReportSeries& series : plot.series) EXPECT_EQ(series.values.size(), 101U);
  }
}

TEST(DrivePlots, ShowClearanceOnlyWhereSomethingIsNear) {
  const auto plots = drive_plots(good_drive(), std::nullopt);
  const auto& values = plots.back().series.at(0).values;
  EXPECT_NEAR(values[40], 0.8, 1e-9);
  EXPECT_TRUE(std::isnan(values[0]));  // 20.8 m away
}

TEST(DrivePlots, ReadTheAuditsProfileBetweenItsSamples) {
  planning::AuditReport audit;
  audit.profile = {{1.0, 3.0}, {2.0, 4.0}};
  const auto plots = drive_plots(good_drive(), audit);
  const auto& values = plots.back().series.at(1).values;
  EXPECT_NEAR(values[15], 3.5, 1e-9);
  EXPECT_NEAR(values[10], 3.0, 1e-9);
  EXPECT_TRUE(std::isnan(values[5]));
  EXPECT_TRUE(std::isnan(values[25]));
}

}  // namespace
}  // namespace roadbed::tools
