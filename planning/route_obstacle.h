#pragma once

#include <string>
#include <vector>

#include "roadbed/planning/route.h"

namespace roadbed::planning {

/// Looks for what keeps a start from a goal, once a search has reached only `reached`: searches
/// again from the goal's side, and with each rule left out in turn.
RouteObstacle find_obstacle(const map::RoadMap& road_map, const map::LanePlace& from,
                            const map::LanePlace& to, const RouteOptions& options,
                            const std::vector<map::LaneId>& reached);

/// The same as one line for the user.
std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const RouteObstacle& obstacle);

}  // namespace roadbed::planning
