// Borders of real maps against an independent evaluation.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/open_drive_oracle.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

struct BorderCheck {
  double worst_curve_to_line_m = 0.0;    // points of the true curve against the polyline
  double worst_vertex_to_curve_m = 0.0;  // vertices against the true curve at their station
  std::size_t lanes = 0;
  std::string worst_lane;
};

void check_lane(const RoadMap& road_map, const Lane& lane, const tests::OpenDriveOracle& oracle,
                BorderCheck& check) {
  const auto [low_s, high_s] = std::minmax(lane.origin.road_from_s_m, lane.origin.road_to_s_m);
  const bool forward = lane.origin.road_from_s_m < lane.origin.road_to_s_m;
  const int id = std::stoi(lane.origin.source_id);
  const bool left_is_outer = (id > 0) == forward;
  const int steps = std::max(4, static_cast<int>((high_s - low_s) / 0.7));
  for (int i = 0; i <= steps; ++i) {
    const double s_m = low_s + (high_s - low_s) * i / steps;
    // Just inside the section, so that a record that begins at its end is not in force.
    const double inside_m = std::clamp(s_m, low_s + 1e-7, high_s - 1e-7);
    const auto [inner, outer] =
        oracle.borders(road_map.road(*lane.road).source_id, lane.origin.section, id, s_m, inside_m);
    const Eigen::Vector2d left = road_map.to_map((left_is_outer ? outer : inner).cast<double>());
    const Eigen::Vector2d right = road_map.to_map((left_is_outer ? inner : outer).cast<double>());
    const double worst = std::max(std::abs(lane.left.in_map.project(left).d_m),
                                  std::abs(lane.right.in_map.project(right).d_m));
    if (worst > check.worst_curve_to_line_m) {
      check.worst_curve_to_line_m = worst;
      check.worst_lane = lane.name;
    }
  }
  for (const bool at_end : {false, true}) {
    const double s_m = at_end ? lane.origin.road_to_s_m : lane.origin.road_from_s_m;
    const double inside_m = std::clamp(s_m, low_s + 1e-7, high_s - 1e-7);
    const auto [inner, outer] =
        oracle.borders(road_map.road(*lane.road).source_id, lane.origin.section, id, s_m, inside_m);
    const Eigen::Vector2d left = road_map.to_map((left_is_outer ? outer : inner).cast<double>());
    const auto& points = lane.left.in_map.points();
    check.worst_vertex_to_curve_m = std::max(
        check.worst_vertex_to_curve_m, (left - (at_end ? points.back() : points.front())).norm());
  }
  ++check.lanes;
}

BorderCheck check_borders(const std::filesystem::path& file, bool only_drivable) {
  const RoadMap road_map = load_map(file);
  const tests::OpenDriveOracle oracle(file.string());
  BorderCheck check;
  for (const Lane& lane : road_map.lanes()) {
    if (only_drivable && !is_drivable(lane.type)) continue;
    check_lane(road_map, lane, oracle, check);
  }
  return check;
}

class TownBorders : public testing::TestWithParam<const char*> {};

TEST_P(TownBorders, AreWithinAMillimetreOfTheCurves) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const BorderCheck check =
      check_borders(real / "opendrive/BerkeleyLearnVerify+Scenic" / GetParam(), false);
  EXPECT_GT(check.lanes, 100u);
  EXPECT_LT(check.worst_curve_to_line_m, 1e-3) << "lane " << check.worst_lane;
  EXPECT_LT(check.worst_vertex_to_curve_m, 1e-6);
  RecordProperty("worst_mm", std::to_string(1e3 * check.worst_curve_to_line_m));
}

INSTANTIATE_TEST_SUITE_P(Towns, TownBorders,
                         testing::Values("Town01.xodr", "Town04.xodr", "Town10HD.xodr"));

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool has_curves(const std::string& text) {
  return text.find("<spiral") != std::string::npos || text.find("<poly3") != std::string::npos ||
         text.find("<paramPoly3") != std::string::npos ||
         text.find("<superelevation") != std::string::npos;
}

// Every other file that has spirals, poly3, paramPoly3 or superelevation.
TEST(CurveBorders, AreWithinAMillimetreOfTheCurves) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(real / "opendrive")) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() != ".xodr" || file.filename().string().starts_with("Town")) continue;
    if (!has_curves(text_of(file))) continue;
    try {
      const BorderCheck check = check_borders(file, false);
      EXPECT_GT(check.lanes, 0u) << file;
      EXPECT_LT(check.worst_curve_to_line_m, 1e-3) << file << " lane " << check.worst_lane;
      EXPECT_LT(check.worst_vertex_to_curve_m, 1e-6) << file;
      ++files;
    } catch (const InputError&) {
      continue;  // the golden table says which are refused, and why
    }
  }
  EXPECT_GE(files, 20);
}

}  // namespace
}  // namespace roadbed::map
