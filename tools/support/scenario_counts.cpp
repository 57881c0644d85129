#include "roadbed/tools/support/scenario_counts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "roadbed/map/formats/common_road_scenario_reader.h"

namespace roadbed::tools {

nlohmann::ordered_json scenario_counts(const std::string& bytes, const std::string& name) {
  namespace common_road = map::common_road;
  if (!common_road::holds_scenario(bytes)) return nullptr;
  const common_road::Scenario scenario = common_road::parse_scenario(bytes, name);
  const auto count = [&](common_road::ObstacleRole role) {
    return std::count_if(scenario.obstacles.begin(), scenario.obstacles.end(),
                         [&](const common_road::Obstacle& o) { return o.role == role; });
  };
  long last_step = 0;
  for (const common_road::Obstacle& obstacle : scenario.obstacles) {
    for (const common_road::State& state : obstacle.trajectory) {
      last_step = std::max(last_step, state.time_step.most);
    }
  }
  return {{"benchmark_id", scenario.benchmark_id},
          {"time_step_s", scenario.time_step_s},
          {"static_obstacles", count(common_road::ObstacleRole::fixed)},
          {"dynamic_obstacles", count(common_road::ObstacleRole::dynamic)},
          {"other_obstacles", count(common_road::ObstacleRole::environment) +
                                  count(common_road::ObstacleRole::phantom)},
          {"recorded_s", static_cast<double>(last_step) * scenario.time_step_s},
          {"planning_problems", scenario.planning_problems.size()}};
}

}  // namespace roadbed::tools
