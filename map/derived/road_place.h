#pragma once

#include <Eigen/Core>
#include <optional>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// A place in the terms of OpenDRIVE: `s` along the road's reference line, `t` to its left.
struct RoadPlace {
  RoadId road;
  double s_m = 0.0;
  double t_m = 0.0;
};

/// Where a point beside a lane is on the lane's road, within the lane's own range of s; none for
/// lanes of no road. O(points of the reference line).
std::optional<RoadPlace> road_place(const RoadMap& road_map, LaneId lane,
                                    const Eigen::Vector2d& point_in_map);

}  // namespace roadbed::map::derived
