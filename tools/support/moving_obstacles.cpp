#include "roadbed/tools/support/moving_obstacles.h"

#include <string>
#include <utility>

#include "roadbed/map/formats/common_road_scenario_reader.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/read_file.h"
#include "roadbed/tools/report/from_map.h"
#include "roadbed/tools/simulation/common_road_world.h"
#include "roadbed/tools/simulation/recorded_obstacle.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"
#include "roadbed/tools/support/obstacles_csv.h"

namespace roadbed::tools {
namespace {

using map::common_road::ObstacleRole;
using planning::MovingObstacle;

std::vector<MovingObstacle> of_common_road(const std::filesystem::path& file) {
  const std::string bytes = map::read_file(file);
  const map::common_road::Scenario from = map::common_road::parse_scenario(bytes, file.string());
  const map::RoadMap road_map = map::parse_map(bytes, file.string());
  const long start_step = from.planning_problems.empty()
                              ? 0
                              : from.planning_problems.front().initial_state.time_step.least;
  std::vector<MovingObstacle> obstacles;
  for (const map::common_road::Obstacle& obstacle : from.obstacles) {
    if (obstacle.role != ObstacleRole::fixed && obstacle.role != ObstacleRole::dynamic) continue;
    const RecordedObstacle recorded =
        recorded_obstacle(obstacle, road_map, start_step, from.time_step_s);
    obstacles.push_back({obstacle_in_source(road_map, recorded.obstacle), recorded.presence.from_s,
                         recorded.presence.to_s});
  }
  return obstacles;
}

std::vector<MovingObstacle> of_scenario(const std::filesystem::path& file) {
  const World world = make_world(read_scenario(file));
  std::vector<MovingObstacle> obstacles;
  for (const planning::Obstacle& obstacle : world.obstacles) {
    obstacles.push_back({obstacle_in_source(world.road_map, obstacle)});
  }
  return obstacles;
}

}  // namespace

std::vector<MovingObstacle> read_moving_obstacles(const std::filesystem::path& file) {
  if (is_common_road(file)) return of_common_road(file);
  if (file.extension() == ".json") return of_scenario(file);
  return parse_obstacles_csv(map::read_file(file), file.string());
}

}  // namespace roadbed::tools
