#pragma once

#include <optional>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline simulation {

/// Where a body is farthest off the road surface.
struct RoadDeparture {
  double off_m = 0.0, at_s = 0.0;
};

/// Judges whether a drive stays on the road surface with its whole body, between the rows too
/// (planning/audit/surface/surface_audit.h); gaps of up to 0.02 m between lanes of real files are
/// none, and edges may be crossed by up to 0.01 m. Fills `off_road_m` of the samples: at the row,
/// or between it and the next one.
/// @returns none if it does. What begins beside the road has left it only after it has been on it.
std::optional<RoadDeparture> judge_road(const map::RoadMap& road_map,
                                        const geometry::VehicleShape& vehicle, Drive& drive);

}  // namespace roadbed::tools::simulation
