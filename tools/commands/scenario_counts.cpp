#include "roadbed/tools/commands/scenario_counts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "roadbed/map/commonroad/scenario_reader.h"
#include "roadbed/map/formats.h"

namespace roadbed::tools::inline commands {

nlohmann::ordered_json scenario_counts(const std::string& bytes, const std::string& name) {
  namespace commonroad = map::commonroad;
  const map::Format* format = map::format_of(bytes);
  if (format == nullptr || format->name != "CommonRoad") return nullptr;
  const commonroad::Scenario scenario = commonroad::parse_scenario(bytes, name);
  const auto count = [&](commonroad::ObstacleRole role) {
    return std::count_if(scenario.obstacles.begin(), scenario.obstacles.end(),
                         [&](const commonroad::Obstacle& o) { return o.role == role; });
  };
  long last_step = 0;
  for (const commonroad::Obstacle& obstacle : scenario.obstacles) {
    for (const commonroad::State& state : obstacle.trajectory) {
      last_step = std::max(last_step, state.time_step.most);
    }
  }
  return {{"benchmark_id", scenario.benchmark_id},
          {"time_step_s", scenario.time_step_s},
          {"static_obstacles", count(commonroad::ObstacleRole::fixed)},
          {"dynamic_obstacles", count(commonroad::ObstacleRole::dynamic)},
          {"other_obstacles",
           count(commonroad::ObstacleRole::environment) + count(commonroad::ObstacleRole::phantom)},
          {"recorded_s", static_cast<double>(last_step) * scenario.time_step_s},
          {"planning_problems", scenario.planning_problems.size()}};
}

}  // namespace roadbed::tools::commands
