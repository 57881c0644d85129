#include "roadbed/tools/simulation/road_departure.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/map/load_map.h"

namespace roadbed::tools {
namespace {

std::string bound(const char* side, double y, double from_x, double to_x) {
  return fmt::format(
      "<{0}><point><x>{1}</x><y>{2}</y></point><point><x>{3}</x><y>{2}</y></point></{0}>", side,
      from_x, y, to_x);
}

std::string lanelet(int id, double from_x, double to_x, double from_y, double to_y) {
  return fmt::format("<lanelet id=\"{}\">{}{}<laneletType>urban</laneletType></lanelet>", id,
                     bound("leftBound", to_y, from_x, to_x),
                     bound("rightBound", from_y, from_x, to_x));
}

/// Road from (0, -3) to (30, 3) with a hole from (9, -0.5) to (11, 0.5).
map::RoadMap road_with_hole() {
  return map::parse_map(
      "<commonRoad commonRoadVersion=\"2020a\" benchmarkID=\"DEU_Hole-1_1_T-1\" "
      "timeStepSize=\"0.1\">" +
          lanelet(1, 0, 9, -3, 3) + lanelet(2, 11, 30, -3, 3) + lanelet(3, 9, 11, 0.5, 3) +
          lanelet(4, 9, 11, -3, -0.5) + "</commonRoad>",
      "hole.xml");
}

/// Straight along y at 1 m/s, a row every `step_m`.
Drive drive_along(double y_m, double from_x_m, double to_x_m, double step_m) {
  std::vector<geometry::TrajectoryPoint> rows;
  Drive drive;
  for (double x = from_x_m; x <= to_x_m + 1e-9; x += step_m) {
    rows.push_back({.t_s = x - from_x_m, .x_m = x, .y_m = y_m, .speed_mps = 1.0});
    drive.samples.push_back({.t_s = x - from_x_m});
  }
  drive.trajectory = geometry::Trajectory(std::move(rows));
  return drive;
}

const geometry::VehicleShape kVehicle;  // 4.508 m by 1.610 m, 0.83 m behind the axle

TEST(RoadDeparture, IsNoneOnTheRoad) {
  Drive drive = drive_along(1.5, 2.0, 20.0, 0.1);
  EXPECT_FALSE(judge_road(road_with_hole(), kVehicle, drive));
  for (const DriveSample& sample : drive.samples) EXPECT_EQ(sample.off_road_m, 0.0) << sample.t_s;
}

TEST(RoadDeparture, IsSeenInTheMiddleOfABodyWhoseCornersAreOnTheRoad) {
  Drive drive = drive_along(0.0, 2.0, 20.0, 0.1);
  const auto departure = judge_road(road_with_hole(), kVehicle, drive);
  ASSERT_TRUE(departure);
  EXPECT_NEAR(departure->off_m, 0.5, 0.125);  // half the hole; points of the body are 0.25 m apart
  for (const DriveSample& sample : drive.samples) {
    const double x_m = 2.0 + sample.t_s;
    const bool is_over = x_m + kVehicle.front_m() > 9.3 && x_m - kVehicle.rear_overhang_m < 10.7;
    const bool is_clear = x_m + kVehicle.front_m() < 9.0 || x_m - kVehicle.rear_overhang_m > 11.1;
    if (is_over || is_clear) {
      EXPECT_EQ(sample.off_road_m > 0.0, is_over) << x_m;
    }
  }
}

TEST(RoadDeparture, IsSeenBetweenRows) {
  Drive drive = drive_along(0.0, 2.0, 20.0, 18.0);
  const auto departure = judge_road(road_with_hole(), kVehicle, drive);
  ASSERT_TRUE(departure);
  EXPECT_GT(departure->at_s, 9.0 - 2.0 - kVehicle.front_m());
  EXPECT_LT(departure->at_s, 11.0 - 2.0 + kVehicle.rear_overhang_m);
  EXPECT_EQ(drive.samples[0].off_road_m, departure->off_m);
}

TEST(RoadDeparture, NeedsARoadThatItHasBeenOn) {
  Drive drive = drive_along(0.0, 9.5, 20.0, 0.1);
  EXPECT_GT(drive.samples.size(), 0u);
  EXPECT_FALSE(judge_road(road_with_hole(), kVehicle, drive));
  EXPECT_GT(drive.samples[0].off_road_m, 0.0);
}

}  // namespace
}  // namespace roadbed::tools
