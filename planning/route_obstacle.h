#pragma once

#include <string>
#include <vector>

#include "roadbed/planning/route.h"
#include "roadbed/planning/route_solver.h"

namespace roadbed::planning {

/// Looks for what keeps a start from a goal that the solver has found no way between: searches from
/// both sides, then with rules left out until a least set of them is known without which there is a
/// way. Some ten searches and as many preparations of the map.
RouteObstacle find_obstacle(const map::RoadMap& road_map, RouteSolver& solver,
                            const map::LanePlace& from, const map::LanePlace& to);

/// The same as one line for the user.
std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const RouteObstacle& obstacle);

}  // namespace roadbed::planning
