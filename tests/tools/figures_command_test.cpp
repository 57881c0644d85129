// `figures` as a user runs it: the tables say what the paper's figures show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tools/files/csv.h"

namespace roadbed::tests {
namespace {

struct FigureRow {
  double x, y;
};
using FigureTable = std::map<std::string, std::vector<FigureRow>>;  // by "panel:series"

FigureTable read_figure(const std::filesystem::path& file) {
  std::istringstream lines(bytes_of(file));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "panel,series,x,y");
  FigureTable table;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = tools::csv_fields(line);
    EXPECT_EQ(fields.size(), 4u) << line;
    table[fields.at(0) + ":" + fields.at(1)].push_back(
        {std::stod(fields.at(2)), std::stod(fields.at(3))});
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
  for (const char* figure :
       {"figure_2_path_model", "figure_3_cubic_spline", "figure_4_corner",
        "figure_5_first_derivative", "figure_6_second_derivative", "figure_7_curvature",
        "figure_8_overtaking", "figure_9_candidates", "figure_10_lqg", "figure_11_tracking_error",
        "figure_12_look_forward_distance", "figure_13_gain", "figure_14_right_turn",
        "figure_14_zig_zag", "figure_14_offset_start", "figure_14_noise"}) {
    names.push_back(std::string(figure) + ".csv");
    names.push_back(std::string(figure) + ".svg");
  }
  std::ranges::sort(names);
  EXPECT_EQ(files_below(*folder_ / "figures"), names);
  const ProgramRun again = run_roadbed({"figures", "-o", (*folder_ / "figures").string()});
  EXPECT_EQ(again.status, 3) << "an existing folder is not replaced";
}

TEST_F(FiguresCommand, CornerHasThePapersControlPoints) {
  const auto points = table("figure_4_corner").at(":control points");
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
  EXPECT_NEAR(peak(":gaps 3, 3, 8 m"), 0.130, 0.001);
  EXPECT_NEAR(peak(":gaps 5, 5, 4 m"), 0.113, 0.001);
}

TEST_F(FiguresCommand, VehicleOvertakesAndComesBack) {
  const FigureTable drive = table("figure_8_overtaking");
  const auto &vehicle = drive.at("a:vehicle, 12 m/s (rear axle)"),
             &other = drive.at("a:car ahead, 4 m/s");
  ASSERT_EQ(vehicle.size(), other.size());
  ASSERT_GT(vehicle.size(), 20u);
  EXPECT_LT(vehicle.front().x, other.front().x - 20.0);
  EXPECT_GT(vehicle.back().x, other.back().x + 20.0);
  for (std::size_t i = 0; i < vehicle.size(); ++i) {
    EXPECT_GT(std::hypot(vehicle[i].x - other[i].x, vehicle[i].y - other[i].y), 1.6);
  }
}

TEST_F(FiguresCommand, CandidatesAreThePapers1596AndTheChosenOneKeepsOffTheParkedCar) {
  const FigureTable candidates = table("figure_9_candidates");
  const std::size_t free = candidates.at(":feasible, free of collision").size(),
                    colliding = candidates.at(":in collision").size(),
                    others = candidates.at(":not feasible").size();
  EXPECT_EQ(free + colliding + others, 16u * 1596u);
  EXPECT_GT(colliding, 16u * 20u);
  const auto& chosen = candidates.at(":optimal");
  EXPECT_NEAR(chosen.front().y, 0.0, 1e-12);
  EXPECT_GE(chosen.back().y, 2.0 - 1e-9);
  // Half the widths are 0.9 and 0.805 m: so far beside its middle where the car stands, at 22 m.
  for (const FigureRow& row : chosen) {
    if (std::abs(row.x - 22.0) > 2.25) continue;
    EXPECT_GT(row.y, 1.705) << row.x;
  }
}

TEST_F(FiguresCommand, FilterIsNearerToTheTruthThanWhatItIsFed) {
  const FigureTable figure = table("figure_10_lqg");
  for (const std::string panel : {"b", "c", "d"}) {
    const auto &truth = figure.at(panel + ":true"), &measured = figure.at(panel + ":measured"),
               &estimated = figure.at(panel + ":estimated by the Kalman filter");
    double squares_measured = 0.0, squares_estimated = 0.0;
    for (std::size_t i = 50; i < truth.size(); ++i) {
      squares_measured += std::pow(measured[i].y - truth[i].y, 2);
      squares_estimated += std::pow(estimated[i].y - truth[i].y, 2);
    }
    EXPECT_LT(squares_estimated, 0.5 * squares_measured) << panel;
  }
}

TEST_F(FiguresCommand, TellsTheSteeringLawsApartFromCrawlingToThirtyMetresPerSecond) {
  const std::string modified = "modified Stanley, eq. 32", original = "original Stanley, eq. 31";
  const FigureTable offset = table("figure_14_offset_start");
  const auto& steering = offset.at("c:" + modified);
  ASSERT_EQ(steering.size(), 9u);
  EXPECT_EQ(steering.front().x, 0.2);
  // At the start: atan(k_e e / L_x) with k_e = 0.504, L_x = 10 m, against atan(k e / v).
  EXPECT_NEAR(steering.front().y, std::atan(0.504 / 10.0), 0.003);
  EXPECT_GT(offset.at("c:" + original).front().y, 0.9);
  const auto &way = offset.at("d:" + modified), &way_of_original = offset.at("d:" + original);
  EXPECT_GT(way.front().y, 20.0 * way_of_original.front().y);
  EXPECT_LT(way.back().y, 0.5 * way_of_original.back().y);
  for (const FigureRow& row : way) EXPECT_NEAR(row.y, 40.0, 10.0) << row.x << " m/s";
  const FigureTable noise = table("figure_14_noise");
  // Up to 5 m/s the modified law steers less and is farther off, from 10 m/s on it is the other
  // way.
  for (const auto& [error, rate] :
       {std::pair<std::string, std::string>{"a:", "b:"}, {"c:", "d:"}}) {
    for (std::size_t i = 0; i < noise.at(error + modified).size(); ++i) {
      const bool is_slow = noise.at(error + modified)[i].x < 7.0;
      EXPECT_EQ(noise.at(error + modified)[i].y > noise.at(error + original)[i].y, is_slow)
          << error << i;
      EXPECT_EQ(noise.at(rate + modified)[i].y < noise.at(rate + original)[i].y, is_slow)
          << rate << i;
    }
  }
  for (const std::string error : {"a:", "c:"}) {  // right turn, zig-zag
    EXPECT_LT(noise.at(error + modified).back().y, 0.6 * noise.at(error + original).back().y);
  }
  for (const std::string rate : {"b:", "d:"}) {
    EXPECT_LT(noise.at(rate + modified).front().y, 0.6 * noise.at(rate + original).front().y);
  }
}

TEST_F(FiguresCommand, TracksThePapersTestsFromFiveToThirtyMetresPerSecond) {
  for (const std::string test : {"right_turn", "zig_zag"}) {
    const FigureTable figure = table("figure_14_" + test);
    for (const auto& [law, bound_m] : std::map<std::string, double>{
             {"c:modified Stanley, eq. 32", 0.012}, {"c:pure pursuit", 0.40}}) {
      ASSERT_EQ(figure.at(law).size(), 6u);
      for (const FigureRow& row : figure.at(law)) {
        EXPECT_LT(row.y, bound_m) << test << " " << row.x << " m/s";
      }
    }
    // The curve over time reaches the largest value, up to what lies between its points.
    for (const FigureRow& row : figure.at("i:modified Stanley, eq. 32")) {
      double found = 0.0;
      for (const FigureRow& at :
           figure.at("h:" + std::to_string(static_cast<int>(row.x)) + " m/s")) {
        found = std::max(found, std::abs(at.y));
      }
      EXPECT_NEAR(found, row.y, 0.02 * row.y) << test << " " << row.x << " m/s";
    }
  }
}

TEST_F(FiguresCommand, SaysWhatIsOtherThanInThePaperAndCutsNoSubscript) {
  for (const char* name : {"figure_9_candidates", "figure_11_tracking_error", "figure_14_noise"}) {
    const std::string svg = bytes_of(*folder_ / ("figures/" + std::string(name) + ".svg"));
    EXPECT_NE(svg.find("class=\"caption\""), std::string::npos) << name;
    EXPECT_EQ(svg.find("_{"), std::string::npos) << name;
    EXPECT_NE(svg.find("<tspan dy=\"0.42em\" font-size=\"0.72em\">"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace roadbed::tests
