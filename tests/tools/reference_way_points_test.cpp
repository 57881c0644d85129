// `reference --waypoints` as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/csv_rows.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Rows = std::vector<std::vector<double>>;

// Eight points of a circle of 20 m around (100, 50).
std::string circle() {
  std::string csv = "x_m,y_m\n";
  for (int i = 0; i < 8; ++i) {
    const double angle = std::numbers::pi * i / 4.0;
    csv += std::to_string(100.0 + 20.0 * std::cos(angle)) + "," +
           std::to_string(50.0 + 20.0 * std::sin(angle)) + "\n";
  }
  return csv;
}

Rows interpolated(const std::vector<std::string>& more) {
  const TemporaryFolder folder;
  const std::string points = folder.write("points.csv", circle());
  std::vector<std::string> arguments = {"reference", "--waypoints",       points,
                                        "-o",        folder / "line.csv", "--interpolate"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = run_roadbed(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return rows_of(folder / "line.csv");
}

TEST(ReferenceWayPoints, PeriodicSplineIsNearlyTheCircleAndCloses) {
  const Rows rows = interpolated({"--ends", "periodic"});
  EXPECT_NEAR(rows.front()[1], rows.back()[1], 1e-9);
  EXPECT_NEAR(rows.front()[2], rows.back()[2], 1e-9);
  EXPECT_NEAR(rows.back()[3] - rows.front()[3], 2.0 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(rows.front()[4], rows.back()[4], 1e-6);
  for (const auto& row : rows) {
    EXPECT_NEAR(std::hypot(row[1] - 100.0, row[2] - 50.0), 20.0, 0.1);
    EXPECT_NEAR(row[4], 0.05, 0.005);
  }
}

TEST(ReferenceWayPoints, NaturalEndsDoNotBendAndClampedOnesHaveTheirHeading) {
  const Rows natural = interpolated({});
  EXPECT_NEAR(natural.front()[4], 0.0, 1e-9);
  EXPECT_NEAR(natural.back()[4], 0.0, 1e-6);
  const Rows clamped = interpolated({"--ends", "clamped", "--headings", "90,45"});
  EXPECT_NEAR(clamped.front()[3], 0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(std::remainder(clamped.back()[3] - 0.25 * std::numbers::pi, 2.0 * std::numbers::pi),
              0.0, 1e-6);
}

TEST(ReferenceWayPoints, SmoothingStaysWithinItsTolerance) {
  const TemporaryFolder folder;
  const std::string points =
      folder.write("points.csv", "x,y\n0,0\n10,0.2\n20,-0.2\n30,0.2\n40,-0.2\n50,0\n60,0\n");
  const ProgramRun run = run_roadbed({"reference", "--waypoints", points, "-o", folder / "line.csv",
                                      "--max-move", "0.25", "--step", "0.1"});
  ASSERT_EQ(run.status, 0) << run.err;
  double peak = 0.0;
  for (const auto& row : rows_of(folder / "line.csv")) {
    EXPECT_LE(std::abs(row[2]), 0.45);
    peak = std::max(peak, std::abs(row[4]));
  }
  EXPECT_LT(peak, 0.015);  // the spline through the points bends by 0.03 1/m
}

TEST(ReferenceWayPoints, RefusesBadPointsAndContradictoryOptions) {
  const TemporaryFolder folder;
  const auto run_with = [&](const std::string& csv, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"reference", "--waypoints", folder.write("p.csv", csv),
                                          "-o", folder / "line.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_roadbed(arguments);
  };
  const ProgramRun one = run_with("x,y\n1,2\n1,2\n", {});
  EXPECT_EQ(one.status, 3);
  EXPECT_THAT(one.err, HasSubstr("p.csv"));
  EXPECT_THAT(one.err, HasSubstr("two distinct"));
  const ProgramRun nan = run_with("x,y\n1,2\nnan,3\n", {});
  EXPECT_EQ(nan.status, 3);
  EXPECT_THAT(nan.err, HasSubstr("p.csv:3"));
  EXPECT_EQ(run_with(circle(), {"--ends", "periodic"}).status, 2);
  EXPECT_EQ(run_with(circle(), {"--interpolate", "--ends", "clamped"}).status, 2);
  EXPECT_EQ(run_with(circle(), {"--from", "1,2"}).status, 2);
  EXPECT_EQ(run_roadbed({"reference", "-o", folder / "line.csv"}).status, 2);
  EXPECT_EQ(files_below(folder.path()), (std::vector<std::string>{"p.csv"}));
}

}  // namespace
}  // namespace roadbed::tests
