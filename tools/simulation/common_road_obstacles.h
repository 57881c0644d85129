#pragma once

#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/task/stop_points.h"
#include "roadbed/tools/simulation/common_road_routes.h"

namespace roadbed::tools::inline simulation {

/// The recorded obstacles that can be hit, in the map, from the problem's start on.
///
/// Files of others hold the ego's own recording at times: an obstacle that starts where the ego
/// does, within 0.1 m and 0.1 rad, and is as large within 0.5 m.
/// @param start  of the ego's rear axle
/// @param drops_ego_recording  leave that out; else it is refused by that name.
/// @throws InputError if a recording has gaps or is not in order of time, or an obstacle touches
///         the ego at the start.
std::vector<planning::Obstacle> obstacles_of(const map::commonroad::Scenario& from,
                                             const ProblemSource& source,
                                             const geometry::Pose2& start,
                                             const geometry::VehicleShape& vehicle,
                                             bool drops_ego_recording);

/// What a file's lights show, in seconds from a time step on: red with yellow is red, and one that
/// is off is dark.
std::vector<planning::LightCycle> light_cycles(const map::commonroad::Scenario& from,
                                               long start_step);

}  // namespace roadbed::tools::simulation
