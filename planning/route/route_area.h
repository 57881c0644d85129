#pragma once

#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/route/route_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::planning::inline route {

/// Part of a lane. Which of its stations is the lower one says nothing.
struct LanePart {
  map::LaneId lane;
  double from_s_m = 0.0, to_s_m = 0.0;
};

/// Area between the borders of parts of lanes, as simple polygons. Exact (CGAL): some milliseconds
/// for a hundred lanes.
std::vector<geometry::Polygon> area_of(const map::RoadMap& road_map,
                                       const std::vector<LanePart>& parts);

/// The corridor of a route: the lanes of its legs, both of them where it changes.
std::vector<LanePart> corridor_of(const map::RoadMap& road_map, const Route& route);

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
