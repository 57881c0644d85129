#pragma once

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::tests {

/// Distance in plan view between a part of a vehicle, grown by a margin, and an occupancy's cell; 0
/// if they meet. Slow and plain: an oracle.
double part_to_cell_m(const geometry::BodyPart& part, double margin_m, const geometry::Pose2& pose,
                      const map::OccupancyCell& cell);

}  // namespace roadbed::tests
