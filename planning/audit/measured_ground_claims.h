#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/ground/measured_ground.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::planning::inline audit {

/// What speaks against places of ground that a certificate has from an occupancy; nothing if at
/// each the lowest occupied cells of the columns within 2 m say so: next to none is below the
/// plane, on all four sides of the drive's direction about half are on it, to a cell, on one level,
/// and their mean is within a fifth of a cell of it. All of the body has a place within 2 m.
///
/// Shares no code with `measured_under`. O(cells + places × columns within 2 m).
std::string measured_ground_fault(const std::vector<map::GroundPlace>& places,
                                  const std::vector<map::OccupancyCell>& cells, double cell_m,
                                  const geometry::Trajectory& drive_in_source,
                                  const map::BodyReach& body);

}  // namespace roadbed::planning::audit
