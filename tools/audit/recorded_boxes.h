#pragma once

#include <string>
#include <vector>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/planning/obstacles/moving_obstacle.h"

namespace roadbed::tools::inline audit {

/// The obstacles of a CommonRoad file as boxes over time that hold all that the file says of them,
/// in source coordinates; second 0 is the initial time step of its first planning problem, else
/// time step 0.
///
/// A trajectory is one box along its heading, linear between its states, there from the first to
/// the last; without a prediction it stands for ever. Each part of an occupancy stands from the
/// start of its first time step to the end of its last, and the initial state before it for its
/// own. An environment obstacle stands for ever. A polygon is held by the least rectangle along one
/// of its edges, a circle by its square. Of several boxes the ids get numbers: 42.1, 42.2.
/// @param name  stands for the file in messages.
/// @throws InputError if an obstacle cannot be held so: a state that gives regions or intervals,
///         states that do not follow each other, nothing that says where it is.
std::vector<planning::MovingObstacle> recorded_boxes(const map::commonroad::Scenario& scenario,
                                                     const std::string& name);

}  // namespace roadbed::tools
