#pragma once

#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/planning/route/route.h"

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

}  // namespace roadbed::planning::route
