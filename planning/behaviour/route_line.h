#pragma once

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline behaviour {

/// The line that a vehicle drives along a route, and what it is drawn with.
struct RouteLine {
  ReferenceLine line;
  ReferenceLineOptions options;
};

/// A lane change takes a while at any speed: the faster it is driven, the longer the line's.
RouteLine line_along(const map::RoadMap& road_map, const Route& route,
                     const geometry::VehicleShape& vehicle, double desired_speed_mps);

}  // namespace roadbed::planning::behaviour
