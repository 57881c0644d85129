// Borders of real maps against an independent evaluation, and every real file read or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "roadbed/map/input_error.h"
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

// Spirals, paramPoly3, superelevation, lane offset.
class CurveBorders : public testing::TestWithParam<const char*> {};

TEST_P(CurveBorders, AreWithinAMillimetreOfTheCurves) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const BorderCheck check = check_borders(real / "opendrive" / GetParam(), false);
  EXPECT_GT(check.lanes, 0u);
  EXPECT_LT(check.worst_curve_to_line_m, 1e-3) << "lane " << check.worst_lane;
  EXPECT_LT(check.worst_vertex_to_curve_m, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Files, CurveBorders,
    testing::Values("esmini+esmini/curves_elevation.xodr", "esmini+esmini/soderleden.xodr",
                    "esmini+esmini/velodrome.xodr", "esmini+esmini/multi_intersections.xodr",
                    "esmini+esmini/lane_width_and_offset.xodr",
                    "esmini+esmini/highway_example_with_merge_and_split.xodr",
                    "ivsg-psu+PathPlanning_MapTools_ParseXODR/WBeaverAve.xodr",
                    "maliput+maliput_malidrive/ParametricCubicCurveComplexRoad.xodr",
                    "maliput+maliput_malidrive/SShapeSuperelevatedRoad.xodr",
                    "maliput+maliput_malidrive/cloverleaf.xodr",
                    "maliput+maliput_malidrive/Roundabout.xodr"),
    [](const auto& test_info) {
      std::string name = std::filesystem::path(test_info.param).stem().string();
      std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
      return name;
    });

TEST(OpenDriveFiles, AreAllReadOrRefusedWithAReason) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  // Why each refused file is refused; all others are read.
  const std::map<std::string, std::string> refused = {
      {"unsupported_schema.xodr", "OpenDRIVE revision 0.8"},
      {"negative16.xodr", "no road with a geometry"},
      {"negative17.xodr", "no road with a geometry"},
      {"negative18.xodr", "no road with a geometry"},
      {"xml.valid_xml_document.negative.xodr", "not well-formed XML"},
      {"SingleRoadNanValues.xodr", "a=\"nan\", needs a finite number"},
  };
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(real / "opendrive")) {
    if (entry.path().extension() != ".xodr") continue;
    ++files;
    const auto expected = refused.find(entry.path().filename().string());
    try {
      const RoadMap road_map = load_map(entry.path());
      EXPECT_EQ(expected, refused.end()) << entry.path() << " was read";
      EXPECT_FALSE(road_map.lanes().empty()) << entry.path();
    } catch (const InputError& error) {
      ASSERT_NE(expected, refused.end()) << error.what();
      EXPECT_NE(std::string(error.what()).find(expected->second), std::string::npos)
          << error.what();
    }
  }
  EXPECT_GE(files, 57);
}

}  // namespace
}  // namespace roadbed::map
