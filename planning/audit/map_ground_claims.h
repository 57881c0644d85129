#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::planning::inline audit {

/// What speaks against places of ground that a certificate has from a map; nothing if each plane is
/// that of a lane there, within 1 mm of height and a thousandth of slope, and one follows the other
/// on one road from the drive's start to its end.
///
/// Shares no code with `road_under`: lanes are looked at one by one, segment by segment.
/// O(places × segments of the lanes within 20 m).
std::string map_ground_fault(const std::vector<map::GroundPlace>& places,
                             const map::RoadMap& road_map,
                             const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::planning::audit
