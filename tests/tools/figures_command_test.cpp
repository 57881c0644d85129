// `figures` as a user runs it: the tables say what the paper's figures show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tools/files/csv.h"

namespace roadbed::tests {
namespace {

struct FigureRow {
  double x, y;
};
using FigureTable = std::map<std::string, std::vector<FigureRow>>;

FigureTable read_figure(const std::filesystem::path& file) {
  std::istringstream lines(bytes_of(file));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "series,x,y");
  FigureTable table;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = tools::csv_fields(line);
    EXPECT_EQ(fields.size(), 3u) << line;
    table[fields.at(0)].push_back({std::stod(fields.at(1)), std::stod(fields.at(2))});
  }
  return table;
}

class FiguresCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    run_ = run_roadbed({"figures", "-o", (*folder_ / "figures").string()});
  }
  static void TearDownTestSuite() { delete folder_; }
  static FigureTable table(const std::string& name) {
    return read_figure(*folder_ / ("figures/" + name + ".csv"));
  }

  inline static TemporaryFolder* folder_ = nullptr;
  inline static ProgramRun run_;
};

TEST_F(FiguresCommand, WritesAPictureAndATableOfEach) {
  ASSERT_EQ(run_.status, 0) << run_.err;
  std::vector<std::string> names;
  for (const char* figure : {"figure_2_path_model", "figure_3_cubic_spline", "figure_4_corner",
                             "figure_5_first_derivative", "figure_6_second_derivative",
                             "figure_7_curvature", "figure_8_overtaking", "figure_9_candidates",
                             "figure_10_lqg", "figure_12_look_forward_distance", "figure_13_gain",
                             "figure_14_right_turn_course", "figure_14_zig_zag_course"}) {
    names.push_back(std::string(figure) + ".csv");
    names.push_back(std::string(figure) + ".svg");
  }
  for (const char* test : {"right_turn", "zig_zag"}) {
    for (const char* of : {"", "largest_"}) {
      for (const char* quantity : {"cross_track", "heading", "steering_rate", "lateral_jerk"}) {
        const std::string name = std::string("figure_14_") + test + "_" + of + quantity;
        names.push_back(name + ".csv");
        names.push_back(name + ".svg");
      }
    }
    for (const char* quantity : {"cross_track", "steering_rate"}) {
      const std::string name = std::string("figure_14_") + test + "_noise_" + quantity;
      names.push_back(name + ".csv");
      names.push_back(name + ".svg");
    }
  }
  for (const char* of : {"cross_track", "largest_steering", "settling"}) {
    names.push_back(std::string("figure_14_offset_start_") + of + ".csv");
    names.push_back(std::string("figure_14_offset_start_") + of + ".svg");
  }
  std::ranges::sort(names);
  EXPECT_EQ(files_below(*folder_ / "figures"), names);
  const ProgramRun again = run_roadbed({"figures", "-o", (*folder_ / "figures").string()});
  EXPECT_EQ(again.status, 3) << "an existing folder is not replaced";
}

TEST_F(FiguresCommand, CornerHasThePapersControlPoints) {
  const auto points = table("figure_4_corner").at("control points P0 … P5");
  ASSERT_EQ(points.size(), 6u);
  const double before[] = {14.0, 11.0, 8.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(points[i].x, -before[i], 1e-9);
    EXPECT_NEAR(points[5 - i].y, before[i], 1e-9);
  }
}

TEST_F(FiguresCommand, DerivativesAndCurvatureAreContinuous) {
  for (const char* name :
       {"figure_5_first_derivative", "figure_6_second_derivative", "figure_7_curvature"}) {
    for (const auto& [series, rows] : table(name)) {
      for (std::size_t i = 1; i < rows.size(); ++i) {
        // The greatest slope is κ′ = 0.142 1/m², or κ = 0.13 1/m for the first derivative.
        EXPECT_LE(std::abs(rows[i].y - rows[i - 1].y), 0.15 * (rows[i].x - rows[i - 1].x) + 1e-9)
            << name << ", " << series << " at " << rows[i].x << " m";
      }
    }
  }
}

TEST_F(FiguresCommand, PeakCurvatureIsThatOfTheGaps) {
  const FigureTable curves = table("figure_7_curvature");
  const auto peak = [&](const std::string& name) {
    return std::ranges::max(curves.at(name), {}, &FigureRow::y).y;
  };
  EXPECT_NEAR(peak("gaps 3, 3, 8 m"), 0.130, 0.001);
  EXPECT_NEAR(peak("gaps 5, 5, 4 m"), 0.113, 0.001);
}

TEST_F(FiguresCommand, VehicleOvertakesAndComesBack) {
  const FigureTable drive = table("figure_8_overtaking");
  const auto &vehicle = drive.at("vehicle, 12 m/s (rear axle)"),
             &other = drive.at("car ahead, 4 m/s");
  ASSERT_EQ(vehicle.size(), other.size());
  ASSERT_GT(vehicle.size(), 20u);
  EXPECT_LT(vehicle.front().x, other.front().x - 20.0);
  EXPECT_GT(vehicle.back().x, other.back().x + 20.0);
  for (std::size_t i = 0; i < vehicle.size(); ++i) {
    EXPECT_GT(std::hypot(vehicle[i].x - other[i].x, vehicle[i].y - other[i].y), 1.6);
  }
}

TEST_F(FiguresCommand, CandidatesAreThePapers1596) {
  const FigureTable candidates = table("figure_9_candidates");
  EXPECT_EQ(candidates.at("candidates").size(), 16u * 1596u);
  const auto& chosen = candidates.at("optimal, free of collision");
  EXPECT_NEAR(chosen.front().y, 0.0, 1e-12);
  EXPECT_GE(chosen.back().y, 2.0 - 1e-9);
}

TEST_F(FiguresCommand, FilterIsNearerToTheTruthThanWhatItIsFed) {
  const FigureTable figure = table("figure_10_lqg");
  const auto &truth = figure.at("true"), &measured = figure.at("measured y"),
             &estimated = figure.at("estimated by the Kalman filter");
  double squares_measured = 0.0, squares_estimated = 0.0;
  for (std::size_t i = 50; i < truth.size(); ++i) {
    squares_measured += std::pow(measured[i].y - truth[i].y, 2);
    squares_estimated += std::pow(estimated[i].y - truth[i].y, 2);
  }
  EXPECT_LT(squares_estimated, 0.5 * squares_measured);
}

TEST_F(FiguresCommand, TellsTheSteeringLawsApartFromCrawlingToThirtyMetresPerSecond) {
  const std::string modified = "modified Stanley, eq. 32", original = "original Stanley, eq. 31";
  const FigureTable steering = table("figure_14_offset_start_largest_steering");
  ASSERT_EQ(steering.at(modified).size(), 9u);
  EXPECT_EQ(steering.at(modified).front().x, 0.2);
  // At the start: atan(k_e e / L_x) with k_e = 0.504, L_x = 10 m, against atan(k e / v).
  EXPECT_NEAR(steering.at(modified).front().y, std::atan(0.504 / 10.0), 0.003);
  EXPECT_GT(steering.at(original).front().y, 0.9);
  const FigureTable way = table("figure_14_offset_start_settling");
  EXPECT_GT(way.at(modified).front().y, 20.0 * way.at(original).front().y);
  EXPECT_LT(way.at(modified).back().y, 0.5 * way.at(original).back().y);
  for (const FigureRow& row : way.at(modified)) EXPECT_NEAR(row.y, 40.0, 10.0) << row.x << " m/s";
  for (const std::string test : {"right_turn", "zig_zag"}) {
    const FigureTable rate = table("figure_14_" + test + "_noise_steering_rate");
    EXPECT_LT(rate.at(modified).front().y, 0.6 * rate.at(original).front().y) << test;
    const FigureTable error = table("figure_14_" + test + "_noise_cross_track");
    EXPECT_LT(error.at(modified).back().y, 0.6 * error.at(original).back().y) << test;
  }
}

TEST_F(FiguresCommand, TracksThePapersTestsFromFiveToThirtyMetresPerSecond) {
  for (const std::string test : {"right_turn", "zig_zag"}) {
    for (const auto& [law, bound_m] : std::map<std::string, double>{
             {"modified Stanley, eq. 32", 0.012}, {"pure pursuit", 0.40}}) {
      const auto rows = table("figure_14_" + test + "_largest_cross_track").at(law);
      ASSERT_EQ(rows.size(), 6u);
      for (const FigureRow& row : rows) EXPECT_LT(row.y, bound_m) << test << " " << row.x << " m/s";
    }
    // The curve over time reaches the largest value, up to what lies between its points.
    const FigureTable curves = table("figure_14_" + test + "_lateral_jerk");
    const auto largest = table("figure_14_" + test + "_largest_lateral_jerk");
    for (const FigureRow& row : largest.at("modified Stanley, eq. 32")) {
      double found = 0.0;
      for (const FigureRow& at : curves.at(std::to_string(static_cast<int>(row.x)) + " m/s")) {
        found = std::max(found, std::abs(at.y));
      }
      EXPECT_NEAR(found, row.y, 0.02 * row.y) << test << " " << row.x << " m/s";
    }
  }
}

}  // namespace
}  // namespace roadbed::tests
