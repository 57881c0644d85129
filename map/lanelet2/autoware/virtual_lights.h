#pragma once

#include <vector>

#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {

/// Whether rules about a virtual traffic light's stretch look at this one: those for the
/// coordination of an intersection, as Autoware's validator does; others may be built otherwise.
bool coordinates_intersection(const VectorMap& map, const Relation& light);

/// The lanelet that a line across the road lies on: the one, of those below it, that holds the
/// largest part of the line; null if there is none.
const Lanelet* lanelet_under(const VectorMap& map, const Way& line);

/// The light's end line on a lanelet that names it: the one of which the largest part lies there;
/// null if there is none.
const Way* end_line_on(const VectorMap& map, const Relation& light, const Lanelet& lanelet);

/// Lanelets from one to another, both among them, in driving direction, the shortest way; empty if
/// there is none. Looks at a thousand lanelets at most.
std::vector<const Lanelet*> shortest_way(const VectorMap& map, const Lanelet& from,
                                         const Lanelet& to);

/// Where a line crosses a way of lanelets: its stations along both outer borders [m], its end that
/// is further to the left at the left one.
struct CrossingStations {
  double left_m = 0.0, right_m = 0.0;
};
CrossingStations stations_of(const VectorMap& map, const Way& line,
                             const std::vector<const Lanelet*>& way);

/// Whether one crossing lies before another one on both sides.
bool is_before(const CrossingStations& one, const CrossingStations& other);

}  // namespace roadbed::map::lanelet2::autoware
