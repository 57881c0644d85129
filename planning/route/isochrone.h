#pragma once

#include <vector>

#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/route_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::planning::inline route {

/// Part of a lane that can be reached. Stations fall where it is driven against its direction.
struct ReachedLane {
  LanePart part;
  bool reversed = false;  ///< driven against its direction
  double cost = 0.0;      ///< at its first station, in the unit of the router's cost
};

/// What can be reached from a place at no more than `limit`, by the router's measure: seconds or
/// metres, with what changes and turns cost. In order of lane; a lane of the start's own lane group
/// may stand twice, once for the part ahead and once for what a loop leads to. A lane that is
/// changed to counts from where its lane group begins.
/// @throws std::invalid_argument as Router::find does, or if the limit is not positive or more than
///         a route may cost.
std::vector<ReachedLane> isochrone(Router& router, const RoutePlace& from, double limit);

}  // namespace roadbed::planning::route
