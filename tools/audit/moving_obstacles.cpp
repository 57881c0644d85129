#include "roadbed/tools/audit/moving_obstacles.h"

#include <string>
#include <utility>

#include "roadbed/map/commonroad/scenario_reader.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/simulation/common_road_world.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::ObstacleInSource;

std::vector<ObstacleInSource> of_scenario(const std::filesystem::path& file, const Inputs& inputs) {
  const World world = make_world(read_scenario(file), inputs);
  std::vector<ObstacleInSource> obstacles;
  for (const planning::Obstacle& obstacle : world.obstacles) {
    obstacles.push_back(planning::obstacle_in_source(world.road_map, obstacle));
  }
  return obstacles;
}

}  // namespace

std::vector<ObstacleInSource> read_moving_obstacles(const std::filesystem::path& file,
                                                    const Inputs& inputs) {
  if (is_common_road(file)) {
    const std::string name = file.string();
    return planning::recorded_boxes(map::commonroad::parse_scenario(map::read_file(file), name),
                                    name);
  }
  if (file.extension() == ".json") return of_scenario(file, inputs);
  return parse_obstacles_csv(map::read_file(file), file.string());
}

}  // namespace roadbed::tools::audit
