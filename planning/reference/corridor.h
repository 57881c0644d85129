#pragma once

#include "roadbed/geometry/curves/smooth_curve.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline reference {

/// Room beside a point of a line that lies in or near a lane.
///
/// To each side the road reaches over the own lane and the drivable ones beyond, as long as the
/// marking between may be crossed, and ends past the first lane of the other direction. Distances
/// are along the line's normal to the outermost border.
/// @param fraction     of the lane's length at the point, about, in driving direction.
/// @param reversed  the lane is driven against its direction.
Corridor room_beside(const map::RoadMap& road_map, map::LaneId lane, double fraction,
                     const geometry::CurvePoint& point, double default_speed_mps,
                     bool reversed = false);

}  // namespace roadbed::planning::reference
