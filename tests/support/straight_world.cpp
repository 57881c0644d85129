#include "roadbed/tests/support/straight_world.h"

#include <memory>
#include <utility>

#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tests {

tools::World straight_world(const StraightRoad& road, std::vector<planning::Obstacle> obstacles) {
  MadeMap made;
  made.parts.format = "made";
  const double y_m = 0.5 * road.width_m, from_m = road.from_x_m, to_m = road.to_x_m;
  const map::LaneId lane = made.add_lane(made.add_road("1"), "-1", {{from_m, y_m}, {to_m, y_m}},
                                         {{from_m, -y_m}, {to_m, -y_m}});
  auto kept_map = std::make_shared<const map::RoadMap>(made.build());
  const map::RoadMap& road_map = *kept_map;
  planning::Route route = *planning::find_route(road_map, {lane, road.start_x_m - from_m},
                                                {lane, road.goal_x_m - from_m})
                               .route;
  planning::ReferenceLine line = planning::ReferenceLine::along(road_map, route);
  return {{.kept_map = std::move(kept_map),
           .field = {},
           .start = {road.start_x_m, 0.0, 0.0},
           .route = std::move(route),
           .line = std::move(line),
           .obstacles = std::move(obstacles)}};
}

}  // namespace roadbed::tests
