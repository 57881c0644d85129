#pragma once

#include <vector>

#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {

/// What each node covers: a ring through the ends of its edges, counter-clockwise around them. As
/// netconvert cuts lanes off at it, it passes through their ends, six centimetres within; where
/// edges meet end to end it is as good as a line across the road. Empty where a road only begins or
/// ends.
///
///              │   │
///        ──────●───●──────
///              │   │        ● corners of the ends
///        ──────●───●──────
///              │   │
std::vector<geometry::Ring> junction_shapes(const RoadMap& road_map, const Net& net);

}  // namespace roadbed::map::sumo
