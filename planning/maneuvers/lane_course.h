#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/traffic.h"

namespace roadbed::planning::inline maneuvers {

/// A lane and those that lead to it, the straightest where there are several, over a length or as
/// far as there are any; the first one is farthest behind.
std::vector<map::LaneId> with_lanes_before(const map::RoadMap& road_map, map::LaneId lane,
                                           double length_m);

/// The middle of lanes that follow on one another.
geometry::Polyline middle_of(const map::RoadMap& road_map, const std::vector<map::LaneId>& lanes);

/// Somebody on a lane, by the lane's middle.
struct MoverOnLane {
  std::size_t obstacle = 0;  ///< index
  double s_m = 0.0;          ///< of its centre
  double half_length_m = 0.0;
  double speed_mps = 0.0;  ///< along the lane
};

/// Those whose centre is so near to a lane's middle and who drive along it or stand, what stands
/// for the whole drive included; not who comes towards or crosses, where other lanes do. In the
/// traffic's order. A projection for each.
std::vector<MoverOnLane> movers_on_lane(const geometry::Polyline& lane, const Traffic& traffic,
                                        double t_s, double within_m);

}  // namespace roadbed::planning::maneuvers
