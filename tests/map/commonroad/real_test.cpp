// What CommonRoad files of others hold. The numbers are commonroad-io's (PyPI, 2026.1), not ours.
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/commonroad/write.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

struct Golden {
  const char* name;
  std::size_t lanelets;
  double length_m;  ///< of all centrelines
  std::size_t successors, neighbours, signs, stop_lines, intersections;
  std::size_t static_obstacles, dynamic_obstacles, states, goals;
};

constexpr Golden kGolden[] = {
    // clang-format off
    {"ARG_Carcarana-1_1_T-1", 152, 6663.921, 204, 152, 9, 0, 10, 0, 5, 165, 1},
    {"ARG_Carcarana-7_1_T-1", 184, 7688.512, 252, 184, 9, 0, 11, 0, 10, 330, 1},
    {"BEL_Aarschot-3_1_T-1", 41, 1175.018, 41, 32, 8, 0, 2, 0, 10, 330, 1},
    {"BEL_Nivelles-4_2_T-1", 32, 1368.930, 32, 32, 6, 0, 3, 0, 10, 330, 1},
    {"BEL_Putte-3_1_T-1", 26, 742.829, 25, 20, 6, 0, 2, 0, 6, 207, 1},
    {"BEL_Zaventem-1_2_T-1", 90, 3341.898, 114, 86, 7, 0, 7, 0, 10, 330, 1},
    {"DEU_Backnang-5_1_T-1", 62, 2932.674, 74, 60, 9, 0, 5, 0, 10, 339, 1},
    {"DEU_BadWaldsee-1_1_T-1", 79, 3200.308, 90, 78, 10, 0, 7, 0, 10, 333, 1},
    {"DEU_Flensburg-35_1_T-1", 26, 1065.489, 24, 22, 5, 0, 1, 0, 18, 1412, 1},
    {"DEU_Guetersloh-20_1_T-1", 16, 731.290, 17, 14, 3, 0, 1, 0, 10, 342, 1},
    {"DEU_IV21-1_2_T-1", 4, 180.000, 2, 4, 1, 0, 0, 0, 2, 90, 1},
    {"DEU_Moabit-4_1_T-1", 51, 995.269, 53, 40, 7, 0, 2, 0, 1, 33, 1},
    {"DEU_Muehlhausen-4_1_T-1", 88, 3078.129, 107, 78, 9, 0, 9, 0, 8, 267, 1},
    {"DEU_Offline-1_1_T-1", 4, 300.000, 2, 4, 1, 0, 0, 1, 1, 69, 1},
    {"DEU_Test-1_1_T-1", 4, 300.000, 2, 4, 1, 0, 0, 1, 1, 69, 1},
    {"ESP_Cambre-2_1_T-1", 33, 1041.814, 37, 12, 6, 0, 6, 0, 7, 231, 1},
    {"ESP_Ceuta-5_1_T-1", 42, 1654.041, 44, 44, 4, 0, 3, 0, 10, 357, 1},
    {"FRA_Miramas-1_1_T-1", 16, 620.090, 15, 14, 3, 0, 1, 0, 8, 267, 1},
    {"GRC_Perama-4_3_T-1", 52, 1994.197, 60, 52, 7, 0, 5, 0, 10, 339, 1},
    {"HRV_Pula-21_1_T-1", 86, 2889.588, 108, 66, 9, 0, 9, 0, 10, 339, 1},
    {"HRV_Pula-29_3_T-1", 73, 2939.379, 90, 72, 7, 0, 6, 0, 10, 333, 1},
    {"HRV_Pula-6_2_T-1", 58, 2279.400, 64, 58, 8, 0, 6, 0, 10, 336, 1},
    {"ITA_Foggia-6_1_T-1", 101, 2780.355, 135, 98, 13, 0, 6, 0, 10, 336, 1},
    {"PRI_Barceloneta-4_3_T-1", 82, 2517.762, 92, 80, 10, 0, 8, 0, 9, 297, 1},
    {"USA_US101-1_1_T-1", 6, 984.173, 0, 10, 0, 0, 0, 0, 2, 120, 1},
    {"USA_US101-6_1_T-1", 5, 1234.696, 0, 8, 0, 0, 0, 0, 29, 1721, 1},
    {"ZAM_Intersection-1_1_T-1", 20, 434.220, 24, 20, 4, 4, 1, 0, 2, 139, 1},
    {"ZAM_Over-1_1", 2, 400.000, 0, 2, 0, 0, 0, 1, 0, 0, 1},
    {"ZAM_Tutorial-1_2_T-1", 3, 597.000, 0, 4, 0, 0, 0, 1, 2, 80, 0},
    {"ZAM_Zip-1_6_T-1", 5, 508.117, 4, 2, 5, 0, 0, 0, 3, 255, 1},
    // clang-format on
};

class CommonRoadFiles : public testing::TestWithParam<Golden> {
 protected:
  static std::string file_of(const std::filesystem::path& folder) {
    const auto set = folder / "commonroad" / "CommonRoad+commonroad-reachable-set";
    return (set / (std::string(GetParam().name) + ".xml")).string();
  }
};

TEST_P(CommonRoadFiles, HoldWhatAnotherReaderFinds) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const RoadMap road_map = load_map(file_of(folder));
  const Golden& golden = GetParam();
  double length_m = 0.0;
  std::size_t successors = 0, neighbours = 0;
  for (const Lane& lane : road_map.lanes()) {
    const LaneLinks& links = road_map.graph().of(lane.id);
    length_m += lane.length_m();
    successors += links.successors.size();
    neighbours += static_cast<std::size_t>(links.left.has_value()) +
                  static_cast<std::size_t>(links.right.has_value());
  }
  EXPECT_EQ(road_map.lanes().size(), golden.lanelets);
  EXPECT_NEAR(length_m, golden.length_m, 1e-3);
  EXPECT_EQ(successors, golden.successors);
  EXPECT_EQ(neighbours, golden.neighbours);
  EXPECT_EQ(road_map.signals().size(), golden.signs);
  EXPECT_EQ(road_map.stop_lines().size(), golden.stop_lines);
  EXPECT_EQ(road_map.regulations().size(), golden.intersections);
}

TEST_P(CommonRoadFiles, HoldTheScenarioThatAnotherReaderFinds) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const std::string file = file_of(folder);
  const auto scenario = commonroad::parse_scenario(read_file(file), file);
  const Golden& golden = GetParam();
  std::size_t fixed = 0, dynamic = 0, states = 0;
  for (const commonroad::Obstacle& obstacle : scenario.obstacles) {
    fixed += static_cast<std::size_t>(obstacle.role == commonroad::ObstacleRole::fixed);
    dynamic += static_cast<std::size_t>(obstacle.role == commonroad::ObstacleRole::dynamic);
    states += obstacle.trajectory.size();
  }
  EXPECT_EQ(fixed, golden.static_obstacles);
  EXPECT_EQ(dynamic, golden.dynamic_obstacles);
  EXPECT_EQ(states, golden.states);
  ASSERT_EQ(scenario.planning_problems.size(), 1U);
  EXPECT_EQ(scenario.planning_problems[0].goals.size(), golden.goals);
}

TEST_P(CommonRoadFiles, ComeBackFromWritingAsTheyWere) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const RoadMap original = load_map(file_of(folder));
  const RoadMap back = parse_map(commonroad::write_common_road(original), "written.xml");
  ASSERT_EQ(back.lanes().size(), original.lanes().size());
  for (const Lane& lane : original.lanes()) {
    const Lane& other = back.lane(lane.id);
    EXPECT_EQ(other.name, lane.name);
    EXPECT_EQ(other.left.in_map.points(), lane.left.in_map.points());
    EXPECT_EQ(other.right.in_map.points(), lane.right.in_map.points());
    EXPECT_EQ(other.type, lane.type);
    EXPECT_EQ(other.participants, lane.participants);
    EXPECT_EQ(other.least_speed_limit_mps(), lane.least_speed_limit_mps());
    EXPECT_EQ(back.graph().of(lane.id).successors, original.graph().of(lane.id).successors);
    const auto &mine = original.graph().of(lane.id).left, &theirs = back.graph().of(lane.id).left;
    ASSERT_EQ(mine.has_value(), theirs.has_value());
    if (!mine) continue;
    EXPECT_EQ(mine->change_windows, theirs->change_windows);
  }
  EXPECT_EQ(back.stop_lines().size(), original.stop_lines().size());
  EXPECT_EQ(back.regulations().size(), original.regulations().size());
}

INSTANTIATE_TEST_SUITE_P(Real, CommonRoadFiles, testing::ValuesIn(kGolden), [](const auto& tested) {
  std::string name = tested.param.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

}  // namespace
}  // namespace roadbed::map
