#include "roadbed/tools/files/trajectory_csv.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::tools {
namespace {

using geometry::Trajectory;
using geometry::TrajectoryPoint;
using testing::HasSubstr;

std::string csv_refusal(std::string_view text) {
  return tests::refusal_of([&] { parse_trajectory_csv(text, "drive.csv"); });
}

TEST(TrajectoryCsv, ReadsBackEveryNumberThatItWroteBitForBit) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> any(-1e6, 1e6), turn(-3.0, 3.0),
      near(-30.0, 30.0);  // rows of a drive are not far apart
  std::vector<TrajectoryPoint> points;
  for (int i = 0; i < 200; ++i) {
    points.push_back({1e5 * i, 5e5 + near(random), 4e6 + near(random), turn(random), any(random),
                      any(random), any(random), any(random)});
  }
  const Trajectory drive(points);
  const Trajectory again = parse_trajectory_csv(write_trajectory_csv(drive), "drive.csv");
  ASSERT_EQ(again.points().size(), drive.points().size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrajectoryPoint &a = again.points()[i], &b = drive.points()[i];
    EXPECT_EQ(a.t_s, b.t_s);
    EXPECT_EQ(a.x_m, b.x_m);
    EXPECT_EQ(a.y_m, b.y_m);
    EXPECT_NEAR(a.heading_rad, b.heading_rad, 1e-12);  // unwrapping adds turns
    EXPECT_EQ(a.speed_mps, b.speed_mps);
    EXPECT_EQ(a.acceleration_mps2, b.acceleration_mps2);
    EXPECT_EQ(a.steering_rad, b.steering_rad);
    EXPECT_EQ(a.curvature_per_m, b.curvature_per_m);
  }
}

TEST(TrajectoryCsv, TakesColumnsByNameInAnyOrderWithSpacesCarriageReturnsAndExtraColumns) {
  const Trajectory drive = parse_trajectory_csv(
      "\xef\xbb\xbfnote, y_m ,x_m,heading_rad,t_s\r\nhello,2, +1.5,0.25,0\r\n\r\n,4,3,0.5,1\r\n",
      "a");
  ASSERT_EQ(drive.points().size(), 2u);
  EXPECT_EQ(drive.points()[0].x_m, 1.5);
  EXPECT_EQ(drive.points()[0].y_m, 2.0);
  EXPECT_EQ(drive.points()[1].heading_rad, 0.5);
  EXPECT_EQ(drive.points()[1].acceleration_mps2, 0.0);
}

TEST(TrajectoryCsv, TakesSpeedsFromTheWayWhereItHasNone) {
  // On a circle of 20 m, forwards and backwards.
  for (const double speed_mps : {4.0, -4.0}) {
    std::string bare = "t_s,x_m,y_m,heading_rad\n", said = "t_s,x_m,y_m,heading_rad,speed_mps\n";
    for (int i = 0; i < 50; ++i) {
      const double heading_rad = 0.005 * speed_mps * i;
      const std::string row = fmt::format("{},{},{},{}", 0.1 * i, 20.0 * std::sin(heading_rad),
                                          -20.0 * std::cos(heading_rad), heading_rad);
      bare += row + "\n";
      said += row + ",7\n";
    }
    const Trajectory drive = parse_trajectory_csv(bare, "a");
    // The chord is shorter than the arc by 1/6 of the square of half its angle.
    for (const TrajectoryPoint& point : drive.points()) {
      EXPECT_NEAR(point.speed_mps, speed_mps, 0.001) << point.t_s;
    }
    EXPECT_EQ(parse_trajectory_csv(said, "a").points()[1].speed_mps, 7.0);
  }
  EXPECT_EQ(parse_trajectory_csv("t_s,x_m,y_m,heading_rad\n0,1,2,0\n", "a").points()[0].speed_mps,
            0.0);
}

TEST(TrajectoryCsv, NamesLineAndColumnOfWhatItCannotUse) {
  const std::string header = "t_s,x_m,y_m,heading_rad\n";
  EXPECT_THAT(csv_refusal("t_s,x_m,heading_rad\n0,0,0\n"), HasSubstr("drive.csv:1: column y_m"));
  EXPECT_THAT(csv_refusal("t_s,t_s,x_m,y_m,heading_rad\n"),
              HasSubstr("column t_s: is there twice"));
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n1,2,zebra,0\n"),
              HasSubstr("drive.csv:3: column y_m: \"zebra\""));
  EXPECT_THAT(csv_refusal(header + "0,nan,0,0\n"), HasSubstr("drive.csv:2: column x_m: \"nan\""));
  EXPECT_THAT(csv_refusal(header + "0,1e300,0,0\n"), HasSubstr("column x_m"));
  EXPECT_THAT(csv_refusal(header + "0,1e999,0,0\n"), HasSubstr("column x_m"));
  EXPECT_THAT(csv_refusal(header + "0,,0,0\n"), HasSubstr("column x_m: \"\""));
  EXPECT_THAT(csv_refusal(header + "0,1,0\n"), HasSubstr("drive.csv:2: row: has 3 fields"));
  EXPECT_THAT(csv_refusal(header), HasSubstr("at least one"));
  EXPECT_THAT(csv_refusal(""), HasSubstr("column t_s"));
}

TEST(TrajectoryCsv, SaysWhereTimeDoesNotIncrease) {
  const std::string header = "t_s,x_m,y_m,heading_rad\n";
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n1,0,0,0\n1,0,0,0\n"), HasSubstr("drive.csv:4"));
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n-1,0,0,0\n"),
              HasSubstr("-1 s does not come after 0 s of the row before"));
}

TEST(TrajectoryCsv, RefusesStepsThatNoVehicleMakes) {
  const std::string header = "t_s,x_m,y_m,heading_rad\n";
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n0.1,1,0,0\n0.2,51,0,0\n"),
              HasSubstr("drive.csv:4: columns x_m, y_m: 50 m in 0.1 s"));
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n0.1,1,0,0\n0.2,20001,0,0\n0.3,3,0,0\n"),
              HasSubstr("drive.csv:4"));
  EXPECT_THAT(csv_refusal(header + "0,0,0,0\n0.1,0.5,0,3.1\n"),
              HasSubstr("drive.csv:3: column heading_rad: turns by 3.1 rad in 0.1 s"));
  // Sparse rows, noise between dense ones, and headings that pass by ±π are a drive.
  EXPECT_EQ(csv_refusal(header + "0,0,0,0\n10,400,0,0\n"), "accepted");
  EXPECT_EQ(csv_refusal(header + "0,0,0,0\n0.001,0.4,0.3,0.1\n0.002,0,0,0\n"), "accepted");
  EXPECT_EQ(csv_refusal(header + "0,0,0,3.1\n0.1,-1,0,-3.1\n0.2,-2,0,3.1\n"), "accepted");
}

// Two rows may be 20.2 km apart, five rows 20.5 km in all.
TEST(TrajectoryCsv, RefusesRowsThatAreTooFarApartToBeFollowed) {
  const std::string header = "t_s,x_m,y_m,heading_rad\n0,0,0,0\n";
  EXPECT_EQ(csv_refusal(header + "1e6,20199,0,0\n"), "accepted");
  EXPECT_THAT(csv_refusal(header + "1e6,20201,0,0\n"),
              HasSubstr("drive.csv:3: columns x_m, y_m: 20201 m from the row before"));
  EXPECT_THAT(csv_refusal(header + "1,1,0,0\n1e4,12001,0,0\n2e4,0,0,0\n20001,1,0,0\n"),
              HasSubstr("drive.csv:5: columns x_m, y_m: 12001 m from the row before, in a drive of "
                        "24003 m, needs at most 20500 m in 5 rows"));
}

// A drive along a bend, with headings as they are and in degrees.
TEST(TrajectoryCsv, RefusesHeadingsThatAreDegrees) {
  for (const double start_rad : {-3.0, -1.5, -0.4, 0.3, 0.8, 1.7, 2.9}) {
    for (const double per_m : {0.0, 0.02, -0.05}) {
      std::string radians = "t_s,x_m,y_m,heading_rad\n", degrees = radians, backwards = radians;
      double x_m = 100.0, y_m = 50.0, heading_rad = start_rad;
      for (int i = 0; i < 100; ++i) {
        radians += fmt::format("{},{},{},{}\n", 0.1 * i, x_m, y_m, heading_rad);
        degrees += fmt::format("{},{},{},{}\n", 0.1 * i, x_m, y_m, heading_rad * 180.0 / M_PI);
        backwards += fmt::format("{},{},{},{}\n", 0.1 * i, x_m, y_m, heading_rad + M_PI);
        x_m += 0.5 * std::cos(heading_rad + 0.25 * per_m);
        y_m += 0.5 * std::sin(heading_rad + 0.25 * per_m);
        heading_rad += 0.5 * per_m;
      }
      EXPECT_EQ(csv_refusal(radians), "accepted") << start_rad << " " << per_m;
      EXPECT_EQ(csv_refusal(backwards), "accepted") << start_rad << " " << per_m;
      EXPECT_THAT(csv_refusal(degrees), HasSubstr("looks like degrees"))
          << start_rad << " " << per_m;
      EXPECT_THAT(csv_refusal(degrees), HasSubstr("divide the headings by 57.29577951308232"));
    }
  }
}

}  // namespace
}  // namespace roadbed::tools
